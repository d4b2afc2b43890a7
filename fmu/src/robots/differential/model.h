/* The differential-drive robot, which is told its wheels' speeds.
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
    double wheel_radius, track, sample_time;
    double wheel_noise_variance;
    double measurement_variance_x, measurement_variance_y, measurement_variance_theta;
    double x_start, y_start, theta_start;
    double wheel_speed_max, motor_time_constant, wheel_radius_error, track_error, wheel_slip;
    int64_t seed, noise, integration;
    /* parameters that may change on the way */
    double wheel_noise_gain, measurement_noise_gain;
    /* inputs: commanded wheel speeds */
    double omega_left, omega_right;
    /* continuous states */
    double x, y, theta;
    /* held from one sample to the next */
    double drive_left, drive_right;             /* what the wheel drives had reached at the sample */
    double wheel_noise_left, wheel_noise_right; /* w_L, w_R */
    double x_meas, y_meas, theta_meas;          /* z_s = x_s + v_s */
    double elapsed;                             /* time since the sample, in co-simulation */
    int64_t sample;                             /* its index s */
    /* following from the rest */
    double v, omega;
    double der_x, der_y, der_theta;
} Robot;

enum { DRIVE_NOISES = 2 };

#endif
