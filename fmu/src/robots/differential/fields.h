/* Fields of a `Robot`: the differential-drive one is told its wheels' speeds. */
#define DRIVE_NOISES 2

/* parameters */
double wheel_radius, track, wheel_speed_max, motor_time_constant, wheel_radius_error, track_error, wheel_slip;
double wheel_noise_variance;
/* one that may change on the way */
double wheel_noise_gain;
/* inputs: commanded wheel speeds */
double omega_left, omega_right;
/* held from one sample to the next */
double drive_left, drive_right;             /* what the wheel drives had reached at the sample */
double wheel_noise_left, wheel_noise_right; /* w_L, w_R */
