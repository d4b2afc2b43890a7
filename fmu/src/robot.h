/* The differential-drive robot: (1) and (3) of docs/theory.md, with wheel and sensor noise on a grid of samples.
 *
 * SI units, angles counter-clockwise. Every field is eight bytes wide, so a Robot has no padding and copies of it
 * compare by their bytes. The fields' meanings, units and bounds are those of the table of variables.
 */
#ifndef LAGLAB_ROBOT_H
#define LAGLAB_ROBOT_H

#include <stdbool.h>
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

/* Puts the robot at its start pose, with sample 0 taken. Call again after changing parameters. */
void robot_start(Robot *robot);

/* Body speeds v, omega from the present inputs and the wheel noise in force (1). */
void robot_speeds(Robot *robot);

/* der_x, der_y, der_theta at the present pose, after `robot_speeds`. */
void robot_derivatives(Robot *robot);

/* First-order change of outputs and derivatives along `direction`, which holds the changes of what they follow from:
 * inputs and pose or, when `starting`, inputs and parameters. Call after `robot_speeds`. */
void robot_tangent(const Robot *robot, const Robot *direction, bool starting, Robot *change);

/* Moves the robot over `step` > 0 seconds with its inputs held, sampling where the sample grid says. */
void robot_step(Robot *robot, double step);

/* The same in pieces: the time that is left to the next sample, a move that ends there at most, whether it is there. */
double robot_to_sample(const Robot *robot);
void robot_move(Robot *robot, double step);
bool robot_is_due(const Robot *robot);

/* Whether no output has overflowed, after `robot_speeds`. */
bool robot_is_finite(const Robot *robot);

/* Takes the next sample here and now: fresh noise and a fresh measurement. */
void robot_sample(Robot *robot);

#endif
