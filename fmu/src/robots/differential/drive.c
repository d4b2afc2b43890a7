/* Two wheels with a drive each: (1). */
#include "drive.h"

#include <math.h>

#include "robot.h"

/* Speed of a wheel drive under command: a first-order lag, sampled; without a time constant it is the command. */
static double wheel_speed(const Robot *robot, double reached, double commanded) {
    return lagged(reached, limited(commanded, robot->wheel_speed_max), robot->sample_time, robot->motor_time_constant);
}

static double wheel_tangent(const Robot *robot, double reached, double commanded, const Robot *d, double d_commanded) {
    const double T = robot->sample_time, tau = robot->motor_time_constant, limit = robot->wheel_speed_max;
    d_commanded = limited_tangent(commanded, d_commanded, limit, d->wheel_speed_max);
    return lagged_tangent(reached - limited(commanded, limit), d_commanded, T, d->sample_time, tau,
                          d->motor_time_constant);
}

static double true_radius(const Robot *robot) {
    return robot->wheel_radius * (1.0 + robot->wheel_radius_error);
}

static double true_track(const Robot *robot) {
    return robot->track * (1.0 + robot->track_error);
}

void drive_start(Robot *robot) {
    robot->drive_left = robot->drive_right = 0.0;
}

void drive_sample(Robot *robot) {
    robot->drive_left = wheel_speed(robot, robot->drive_left, robot->omega_left);
    robot->drive_right = wheel_speed(robot, robot->drive_right, robot->omega_right);
}

void drive_shake(Robot *robot, const double w[DRIVE_NOISES]) {
    const double shaken = robot->wheel_noise_gain;
    robot->wheel_noise_left = shaken * (sqrt(robot->wheel_noise_variance) * w[0]);
    robot->wheel_noise_right = shaken * (sqrt(robot->wheel_noise_variance) * w[1]);
}

void robot_speeds(Robot *robot) {
    const double grip = 1.0 - robot->wheel_slip;
    const double r = true_radius(robot), L = true_track(robot);
    const double left = wheel_speed(robot, robot->drive_left, robot->omega_left) + robot->wheel_noise_left;
    const double right = wheel_speed(robot, robot->drive_right, robot->omega_right) + robot->wheel_noise_right;
    /* (1) v = r (w_R + w_L) / 2, omega = r (w_R - w_L) / L */
    robot->v = grip * (r * (right + left) / 2.0);
    robot->omega = grip * (r * (right - left) / L);
}

void drive_shake_tangent(const Robot *robot, const Robot *d, const double w[DRIVE_NOISES], Robot *change) {
    const double shaken = robot->wheel_noise_gain, d_shaken = d->wheel_noise_gain;
    change->wheel_noise_left =
        noise_tangent(shaken, robot->wheel_noise_variance, w[0], d_shaken, d->wheel_noise_variance);
    change->wheel_noise_right =
        noise_tangent(shaken, robot->wheel_noise_variance, w[1], d_shaken, d->wheel_noise_variance);
}

void drive_still(Robot *change) {
    change->wheel_noise_left = change->wheel_noise_right = 0.0;
}

/* (1), differentiated. */
void drive_tangent(const Robot *robot, const Robot *d, Robot *change) {
    const double grip = 1.0 - robot->wheel_slip, d_grip = -d->wheel_slip;
    const double r = true_radius(robot), L = true_track(robot);
    const double d_r =
        d->wheel_radius * (1.0 + robot->wheel_radius_error) + robot->wheel_radius * d->wheel_radius_error;
    const double d_L = d->track * (1.0 + robot->track_error) + robot->track * d->track_error;
    const double left = wheel_speed(robot, robot->drive_left, robot->omega_left) + robot->wheel_noise_left;
    const double right = wheel_speed(robot, robot->drive_right, robot->omega_right) + robot->wheel_noise_right;
    const double d_left =
        wheel_tangent(robot, robot->drive_left, robot->omega_left, d, d->omega_left) + change->wheel_noise_left;
    const double d_right =
        wheel_tangent(robot, robot->drive_right, robot->omega_right, d, d->omega_right) + change->wheel_noise_right;
    const double gain = grip * r, d_gain = d_grip * r + grip * d_r;
    change->v = (gain * (d_right + d_left) + d_gain * (right + left)) / 2.0;
    change->omega = (gain * (d_right - d_left) + d_gain * (right - left) - robot->omega * d_L) / L;
}
