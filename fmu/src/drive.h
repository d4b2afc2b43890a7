/* What differs between the robots that ship: how commands become body speeds.
 * Each has a `fields.h`, its variables, and a `drive.c`: this, and `robot_speeds`. */
#ifndef LAGLAB_DRIVE_H
#define LAGLAB_DRIVE_H

#include <math.h>

#include "model.h"

/* At rest, at the start. */
void drive_start(Robot *robot);

/* What it has reached by the end of a sample; the next one goes on from there. */
void drive_sample(Robot *robot);

/* Its noise over the next sample, from normal numbers. */
void drive_shake(Robot *robot, const double w[DRIVE_NOISES]);

/* First-order change along `d`: of the noise at the start, of no noise, of v and omega. */
void drive_shake_tangent(const Robot *robot, const Robot *d, const double w[DRIVE_NOISES], Robot *change);
void drive_still(Robot *change);
void drive_tangent(const Robot *robot, const Robot *d, Robot *change);

/* Within a limit, to either side; a limit of zero is none. */
static inline double limited(double value, double limit) {
    return limit > 0 && fabs(value) > limit ? copysign(limit, value) : value;
}

static inline double limited_tangent(double value, double d_value, double limit, double d_limit) {
    return limit > 0 && fabs(value) > limit ? copysign(1.0, value) * d_limit : d_value;
}

/* A first-order lag, sampled: from what was reached to what is commanded; without a time constant it is the command. */
static inline double lagged(double reached, double commanded, double T, double tau) {
    return tau > 0 ? commanded + (reached - commanded) * exp(-T / tau) : commanded;
}

static inline double lagged_tangent(double behind, double d_commanded, double T, double d_T, double tau, double d_tau) {
    if (!(tau > 0)) {
        return d_commanded;
    }
    const double lag = exp(-T / tau), d_lag = lag * (T / tau * d_tau - d_T) / tau;
    return d_commanded * (1.0 - lag) + behind * d_lag;
}

/* Of gain sqrt(variance) w; infinite for a variance that leaves zero. */
static inline double noise_tangent(double gain, double variance, double w, double d_gain, double d_variance) {
    const double by_variance = d_variance != 0.0 && w != 0.0 ? gain * w / (2.0 * sqrt(variance)) * d_variance : 0.0;
    return d_gain * sqrt(variance) * w + by_variance;
}

#endif
