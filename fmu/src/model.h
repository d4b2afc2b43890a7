/* A robot's variables: those of its drive, from its own `fields.h`, and those that every robot has.
 *
 * Every field is eight bytes wide, so a Robot has no padding and copies of it compare by their bytes. The fields'
 * meanings, units and bounds are those of the table of variables.
 */
#ifndef LAGLAB_MODEL_H
#define LAGLAB_MODEL_H

#include <stdint.h>

enum { INTEGRATION_EULER = 1, INTEGRATION_EXACT = 2 };

typedef struct {
#include "fields.h"
    /* parameters */
    double sample_time;
    double measurement_variance_x, measurement_variance_y, measurement_variance_theta;
    double x_start, y_start, theta_start;
    int64_t seed, noise, integration;
    /* one that may change on the way */
    double measurement_noise_gain;
    /* continuous states */
    double x, y, theta;
    /* held from one sample to the next */
    double x_meas, y_meas, theta_meas; /* z_s = x_s + v_s */
    double elapsed;                    /* time since the sample, in co-simulation */
    int64_t sample;                    /* its index s */
    /* following from the rest */
    double v, omega;
    double der_x, der_y, der_theta;
} Robot;

#endif
