/* Fields of a `Robot`: the car-like one drives with its rear wheels and steers with its front ones, which lag. */
#define DRIVE_NOISES 2

/* parameters */
double wheelbase, speed_max, steering_max, speed_time_constant, steering_time_constant;
double speed_noise_variance, steering_noise_variance;
/* one that may change on the way */
double drive_noise_gain;
/* inputs: commanded body speeds */
double v_command, omega_command;
/* held from one sample to the next */
double speed, steering;             /* what drive and steering had reached at the sample */
double speed_noise, steering_noise; /* of the sample */
