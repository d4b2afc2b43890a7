/* Rear wheels that drive, front wheels that steer: omega = v tan(steering) / wheelbase. */
#include "drive.h"

#include <math.h>

#include "robot.h"

/* The commanded steering angle is that of (v, omega); at a standstill it is the largest, to the side of omega. */
static double wanted(const Robot *robot) {
    const double ahead = copysign(1.0, robot->v_command);
    return atan2(ahead * robot->wheelbase * robot->omega_command, fabs(robot->v_command));
}

static double wanted_tangent(const Robot *robot, const Robot *d) {
    const double ahead = copysign(1.0, robot->v_command), m = fabs(robot->v_command);
    const double n = ahead * robot->wheelbase * robot->omega_command;
    const double d_n = ahead * (robot->wheelbase * d->omega_command + d->wheelbase * robot->omega_command);
    const double square = m * m + n * n;
    return square > 0.0 ? (m * d_n - n * ahead * d->v_command) / square : 0.0;
}

static double commanded_speed(const Robot *robot) {
    return limited(robot->v_command, robot->speed_max);
}

static double commanded_steering(const Robot *robot) {
    return limited(wanted(robot), robot->steering_max);
}

static double speed_now(const Robot *robot) {
    return lagged(robot->speed, commanded_speed(robot), robot->sample_time, robot->speed_time_constant);
}

static double steering_now(const Robot *robot) {
    return lagged(robot->steering, commanded_steering(robot), robot->sample_time, robot->steering_time_constant);
}

void drive_start(Robot *robot) {
    robot->speed = robot->steering = 0.0;
}

void drive_sample(Robot *robot) {
    const double speed = speed_now(robot), steering = steering_now(robot);
    robot->speed = speed;
    robot->steering = steering;
}

void drive_shake(Robot *robot, const double w[DRIVE_NOISES]) {
    robot->speed_noise = robot->drive_noise_gain * (sqrt(robot->speed_noise_variance) * w[0]);
    robot->steering_noise = robot->drive_noise_gain * (sqrt(robot->steering_noise_variance) * w[1]);
}

void robot_speeds(Robot *robot) {
    robot->v = speed_now(robot) + robot->speed_noise;
    robot->omega = robot->v * tan(steering_now(robot) + robot->steering_noise) / robot->wheelbase;
}

void drive_shake_tangent(const Robot *robot, const Robot *d, const double w[DRIVE_NOISES], Robot *change) {
    const double gain = robot->drive_noise_gain, d_gain = d->drive_noise_gain;
    change->speed_noise = noise_tangent(gain, robot->speed_noise_variance, w[0], d_gain, d->speed_noise_variance);
    change->steering_noise =
        noise_tangent(gain, robot->steering_noise_variance, w[1], d_gain, d->steering_noise_variance);
}

void drive_still(Robot *change) {
    change->speed_noise = change->steering_noise = 0.0;
}

void drive_tangent(const Robot *robot, const Robot *d, Robot *change) {
    const double T = robot->sample_time, d_T = d->sample_time;
    const double d_v = limited_tangent(robot->v_command, d->v_command, robot->speed_max, d->speed_max);
    const double d_speed = lagged_tangent(robot->speed - commanded_speed(robot), d_v, T, d_T,
                                          robot->speed_time_constant, d->speed_time_constant);
    const double d_angle =
        limited_tangent(wanted(robot), wanted_tangent(robot, d), robot->steering_max, d->steering_max);
    const double d_steering = lagged_tangent(robot->steering - commanded_steering(robot), d_angle, T, d_T,
                                             robot->steering_time_constant, d->steering_time_constant);
    const double slope = tan(steering_now(robot) + robot->steering_noise);
    const double d_slope = (1.0 + slope * slope) * (d_steering + change->steering_noise);
    change->v = d_speed + change->speed_noise;
    change->omega = (change->v * slope + robot->v * d_slope - robot->omega * d->wheelbase) / robot->wheelbase;
}
