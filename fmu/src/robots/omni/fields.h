/* Fields of a `Robot`: the omnidirectional one has three wheels a third of a turn apart, whose rollers let them slide
 * along their axes. */
#define DRIVE_NOISES 3
#define DRIVE_SLIDES

/* parameters */
double wheel_radius, body_radius, wheel_speed_max, motor_time_constant, wheel_radius_error, first_wheel_error;
double wheel_noise_variance;
/* one that may change on the way */
double wheel_noise_gain;
/* inputs: commanded body speeds */
double v_command, omega_command;
/* held from one sample to the next */
double drive[3];       /* what the wheel drives had reached at the sample */
double wheel_noise[3]; /* of the sample */
/* following from the rest */
double sideways;
