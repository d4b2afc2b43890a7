/* Three wheels, each rolling along the rim at its place and sliding across it. */
#include "drive.h"

#include <math.h>

#include "robot.h"

enum { WHEELS = 3 };

/* Where the wheels are, as seen from the heading: a sixth of a turn to the left, behind, and to the right. */
static const double COS[WHEELS] = {0.5, -1.0, 0.5};
static const double SIN[WHEELS] = {0.8660254037844386, 0.0, -0.8660254037844386};

static double true_radius(const Robot *robot, int i) {
    return robot->wheel_radius * (1.0 + robot->wheel_radius_error) * (i == 0 ? 1.0 + robot->first_wheel_error : 1.0);
}

static double radius_tangent(const Robot *robot, const Robot *d, int i) {
    const double all = 1.0 + robot->wheel_radius_error, first = i == 0 ? 1.0 + robot->first_wheel_error : 1.0;
    const double d_first = i == 0 ? d->first_wheel_error : 0.0;
    return d->wheel_radius * all * first + robot->wheel_radius * (d->wheel_radius_error * first + all * d_first);
}

/* What a wheel is to turn at, for the robot to go ahead at v and to turn at omega. */
static double wanted(const Robot *robot, int i) {
    return (robot->body_radius * robot->omega_command - SIN[i] * robot->v_command) / robot->wheel_radius;
}

static double commanded(const Robot *robot, int i) {
    return limited(wanted(robot, i), robot->wheel_speed_max);
}

static double wheel_speed(const Robot *robot, int i) {
    return lagged(robot->drive[i], commanded(robot, i), robot->sample_time, robot->motor_time_constant);
}

static double wheel_tangent(const Robot *robot, const Robot *d, int i) {
    const double d_wanted = (robot->body_radius * d->omega_command + d->body_radius * robot->omega_command -
                             SIN[i] * d->v_command - wanted(robot, i) * d->wheel_radius) /
                            robot->wheel_radius;
    const double d_commanded = limited_tangent(wanted(robot, i), d_wanted, robot->wheel_speed_max, d->wheel_speed_max);
    return lagged_tangent(robot->drive[i] - commanded(robot, i), d_commanded, robot->sample_time, d->sample_time,
                          robot->motor_time_constant, d->motor_time_constant);
}

void drive_start(Robot *robot) {
    for (int i = 0; i < WHEELS; i++) {
        robot->drive[i] = 0.0;
    }
}

void drive_sample(Robot *robot) {
    for (int i = 0; i < WHEELS; i++) {
        robot->drive[i] = wheel_speed(robot, i);
    }
}

void drive_shake(Robot *robot, const double w[DRIVE_NOISES]) {
    for (int i = 0; i < WHEELS; i++) {
        robot->wheel_noise[i] = robot->wheel_noise_gain * (sqrt(robot->wheel_noise_variance) * w[i]);
    }
}

/* From the rims' speeds to those of the body: ahead, to the left, turning. */
static void body_speeds(const double rim[WHEELS], double body_radius, Robot *robot) {
    robot->v = robot->sideways = robot->omega = 0.0;
    for (int i = 0; i < WHEELS; i++) {
        robot->v -= 2.0 / 3.0 * SIN[i] * rim[i];
        robot->sideways += 2.0 / 3.0 * COS[i] * rim[i];
        robot->omega += rim[i] / (3.0 * body_radius);
    }
}

void robot_speeds(Robot *robot) {
    double rim[WHEELS];
    for (int i = 0; i < WHEELS; i++) {
        rim[i] = true_radius(robot, i) * (wheel_speed(robot, i) + robot->wheel_noise[i]);
    }
    body_speeds(rim, robot->body_radius, robot);
}

void drive_shake_tangent(const Robot *robot, const Robot *d, const double w[DRIVE_NOISES], Robot *change) {
    for (int i = 0; i < WHEELS; i++) {
        change->wheel_noise[i] = noise_tangent(robot->wheel_noise_gain, robot->wheel_noise_variance, w[i],
                                               d->wheel_noise_gain, d->wheel_noise_variance);
    }
}

void drive_still(Robot *change) {
    for (int i = 0; i < WHEELS; i++) {
        change->wheel_noise[i] = 0.0;
    }
}

void drive_tangent(const Robot *robot, const Robot *d, Robot *change) {
    double d_rim[WHEELS];
    for (int i = 0; i < WHEELS; i++) {
        const double turning = wheel_speed(robot, i) + robot->wheel_noise[i];
        const double d_turning = wheel_tangent(robot, d, i) + change->wheel_noise[i];
        d_rim[i] = true_radius(robot, i) * d_turning + radius_tangent(robot, d, i) * turning;
    }
    body_speeds(d_rim, robot->body_radius, change);
    change->omega -= robot->omega * d->body_radius / robot->body_radius;
}
