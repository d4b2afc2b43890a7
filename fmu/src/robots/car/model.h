/* The car-like robot: it drives with its rear wheels and steers with its front ones, which lag.
 *
 * Every field is eight bytes wide, so a Robot has no padding and copies of it compare by their bytes. The fields'
 * meanings, units and bounds are those of the table of variables.
 */
#ifndef LAGLAB_MODEL_H
#define LAGLAB_MODEL_H

#include <stdint.h>

enum { INTEGRATION_EULER = 1, INTEGRATION_EXACT = 2 };

typedef struct {
    /* parameters */
    double wheelbase, speed_max, steering_max, speed_time_constant, steering_time_constant;
    double speed_noise_variance, steering_noise_variance;
    double sample_time;
    double measurement_variance_x, measurement_variance_y, measurement_variance_theta;
    double x_start, y_start, theta_start;
    int64_t seed, noise, integration;
    /* parameters that may change on the way */
    double drive_noise_gain, measurement_noise_gain;
    /* inputs: commanded body speeds */
    double v_command, omega_command;
    /* continuous states */
    double x, y, theta;
    /* held from one sample to the next */
    double speed, steering;             /* what drive and steering had reached at the sample */
    double speed_noise, steering_noise; /* of the sample */
    double x_meas, y_meas, theta_meas;  /* z_s = x_s + v_s */
    double elapsed;                     /* time since the sample, in co-simulation */
    int64_t sample;                     /* its index s */
    /* following from the rest */
    double v, omega;
    double der_x, der_y, der_theta;
} Robot;

enum { DRIVE_NOISES = 2 };

#endif
