#include "robot.h"

#include <math.h>
#include <string.h>

#include "noise.h"

/* Two instants closer than this part of the sample time are the same instant, computed in two ways. */
static const double TIME_TOLERANCE = 1e-9;

enum { WHEEL_NOISE, MEASUREMENT_NOISE }; /* streams */

static double clamp(double value, double limit) {
    return value > limit ? limit : value < -limit ? -limit : value;
}

/* What is left of a difference between command and drive speed after one sample. */
static double lag(const Robot *robot) {
    return robot->motor_time_constant > 0 ? exp(-robot->sample_time / robot->motor_time_constant) : 0.0;
}

/* Speed of a wheel drive under command: a first-order lag, sampled; without a time constant it is the command. */
static double drive_speed(const Robot *robot, double reached, double commanded) {
    if (robot->wheel_speed_max > 0) {
        commanded = clamp(commanded, robot->wheel_speed_max);
    }
    return robot->motor_time_constant > 0 ? commanded + (reached - commanded) * lag(robot) : commanded;
}

static double drive_tangent(const Robot *robot, double reached, double commanded, const Robot *d, double d_commanded) {
    if (robot->wheel_speed_max > 0 && fabs(commanded) > robot->wheel_speed_max) {
        d_commanded = copysign(d->wheel_speed_max, commanded);
        commanded = clamp(commanded, robot->wheel_speed_max);
    }
    if (!(robot->motor_time_constant > 0)) {
        return d_commanded;
    }
    const double tau = robot->motor_time_constant, T = robot->sample_time;
    const double d_lag = lag(robot) * (T / tau * d->motor_time_constant - d->sample_time) / tau;
    return d_commanded * (1.0 - lag(robot)) + (reached - commanded) * d_lag;
}

static double true_radius(const Robot *robot) {
    return robot->wheel_radius * (1.0 + robot->wheel_radius_error);
}

static double true_track(const Robot *robot) {
    return robot->track * (1.0 + robot->track_error);
}

void robot_speeds(Robot *robot) {
    const double grip = 1.0 - robot->wheel_slip;
    const double r = true_radius(robot), L = true_track(robot);
    const double left = drive_speed(robot, robot->drive_left, robot->omega_left) + robot->wheel_noise_left;
    const double right = drive_speed(robot, robot->drive_right, robot->omega_right) + robot->wheel_noise_right;
    /* (1) v = r (w_R + w_L) / 2, omega = r (w_R - w_L) / L */
    robot->v = grip * (r * (right + left) / 2.0);
    robot->omega = grip * (r * (right - left) / L);
}

void robot_derivatives(Robot *robot) {
    robot->der_x = robot->v * cos(robot->theta);
    robot->der_y = robot->v * sin(robot->theta);
    robot->der_theta = robot->omega;
}

/* (3) x <- x + T v cos theta, y <- y + T v sin theta, theta <- theta + T omega */
static void move_euler(Robot *robot, double T) {
    robot->x += T * robot->v * cos(robot->theta);
    robot->y += T * robot->v * sin(robot->theta);
    robot->theta += T * robot->omega;
}

/* Along the arc: a chord of length T v sin(a) / a in the direction theta + a, where a = T omega / 2. */
static void move_exact(Robot *robot, double T) {
    const double a = T * robot->omega / 2.0;
    const double chord = T * robot->v * (a != 0.0 ? sin(a) / a : 1.0);
    robot->x += chord * cos(robot->theta + a);
    robot->y += chord * sin(robot->theta + a);
    robot->theta += T * robot->omega;
}

static void move(Robot *robot, double T) {
    if (robot->integration == INTEGRATION_EXACT) {
        move_exact(robot, T);
    } else {
        move_euler(robot, T);
    }
}

/* The sample's normal numbers. A variance of zero draws too: switching one noise off leaves the other as it was. */
static void draw_normal(const Robot *robot, double w[2], double v[3]) {
    memset(w, 0, 2 * sizeof *w);
    memset(v, 0, 3 * sizeof *v);
    if (robot->noise) {
        noise_normal((uint64_t)robot->seed, (uint64_t)robot->sample, WHEEL_NOISE, 2, w);
        noise_normal((uint64_t)robot->seed, (uint64_t)robot->sample, MEASUREMENT_NOISE, 3, v);
    }
}

static void draw(Robot *robot) {
    double w[2], v[3];
    draw_normal(robot, w, v);
    const double shaken = robot->wheel_noise_gain, misread = robot->measurement_noise_gain;
    robot->wheel_noise_left = shaken * (sqrt(robot->wheel_noise_variance) * w[0]);
    robot->wheel_noise_right = shaken * (sqrt(robot->wheel_noise_variance) * w[1]);
    robot->x_meas = robot->x + misread * (sqrt(robot->measurement_variance_x) * v[0]);
    robot->y_meas = robot->y + misread * (sqrt(robot->measurement_variance_y) * v[1]);
    robot->theta_meas = robot->theta + misread * (sqrt(robot->measurement_variance_theta) * v[2]);
}

/* Of gain sqrt(variance) w; infinite for a variance that leaves zero. */
static double noise_tangent(double gain, double variance, double w, double d_gain, double d_variance) {
    const double by_variance = d_variance != 0.0 && w != 0.0 ? gain * w / (2.0 * sqrt(variance)) * d_variance : 0.0;
    return d_gain * sqrt(variance) * w + by_variance;
}

void robot_start(Robot *robot) {
    robot->x = robot->x_start;
    robot->y = robot->y_start;
    robot->theta = robot->theta_start;
    robot->drive_left = robot->drive_right = 0.0;
    robot->elapsed = 0.0;
    robot->sample = 0;
    draw(robot);
}

void robot_sample(Robot *robot) {
    robot->drive_left = drive_speed(robot, robot->drive_left, robot->omega_left);
    robot->drive_right = drive_speed(robot, robot->drive_right, robot->omega_right);
    robot->elapsed = 0.0;
    robot->sample++;
    draw(robot);
}

bool robot_is_finite(const Robot *robot) {
    /* zero times a finite number is zero, times anything else it is none; quicker than eight questions */
    const double pose = 0.0 * robot->x + 0.0 * robot->y + 0.0 * robot->theta;
    const double measured = 0.0 * robot->x_meas + 0.0 * robot->y_meas + 0.0 * robot->theta_meas;
    return pose + measured + 0.0 * robot->v + 0.0 * robot->omega == 0.0;
}

double robot_to_sample(const Robot *robot) {
    return robot->sample_time - robot->elapsed;
}

bool robot_is_due(const Robot *robot) {
    return robot->elapsed >= robot->sample_time;
}

void robot_move(Robot *robot, double step) {
    const double to_sample = robot_to_sample(robot);
    const bool reached = step >= to_sample - TIME_TOLERANCE * robot->sample_time;
    robot_speeds(robot);
    move(robot, reached ? to_sample : step);
    robot->elapsed = reached ? robot->sample_time : robot->elapsed + step;
}

void robot_step(Robot *robot, double step) {
    while (step > TIME_TOLERANCE * robot->sample_time) {
        const double to_sample = robot_to_sample(robot);
        robot_move(robot, step);
        if (robot_is_due(robot)) {
            robot_sample(robot);
        }
        step -= to_sample;
    }
}

static void start_tangent(const Robot *robot, const Robot *d, Robot *change) {
    double w[2], v[3];
    draw_normal(robot, w, v);
    const double shaken = robot->wheel_noise_gain, misread = robot->measurement_noise_gain;
    const double d_shaken = d->wheel_noise_gain, d_misread = d->measurement_noise_gain;
    change->x = d->x_start;
    change->y = d->y_start;
    change->theta = d->theta_start;
    change->wheel_noise_left =
        noise_tangent(shaken, robot->wheel_noise_variance, w[0], d_shaken, d->wheel_noise_variance);
    change->wheel_noise_right =
        noise_tangent(shaken, robot->wheel_noise_variance, w[1], d_shaken, d->wheel_noise_variance);
    change->x_meas = d->x_start + noise_tangent(misread, robot->measurement_variance_x, v[0], d_misread,
                                                d->measurement_variance_x);
    change->y_meas = d->y_start + noise_tangent(misread, robot->measurement_variance_y, v[1], d_misread,
                                                d->measurement_variance_y);
    change->theta_meas = d->theta_start + noise_tangent(misread, robot->measurement_variance_theta, v[2], d_misread,
                                                        d->measurement_variance_theta);
}

/* (1), differentiated. */
static void speeds_tangent(const Robot *robot, const Robot *d, Robot *change) {
    const double grip = 1.0 - robot->wheel_slip, d_grip = -d->wheel_slip;
    const double r = true_radius(robot), L = true_track(robot);
    const double d_r = d->wheel_radius * (1.0 + robot->wheel_radius_error) + robot->wheel_radius * d->wheel_radius_error;
    const double d_L = d->track * (1.0 + robot->track_error) + robot->track * d->track_error;
    const double left = drive_speed(robot, robot->drive_left, robot->omega_left) + robot->wheel_noise_left;
    const double right = drive_speed(robot, robot->drive_right, robot->omega_right) + robot->wheel_noise_right;
    const double d_left =
        drive_tangent(robot, robot->drive_left, robot->omega_left, d, d->omega_left) + change->wheel_noise_left;
    const double d_right =
        drive_tangent(robot, robot->drive_right, robot->omega_right, d, d->omega_right) + change->wheel_noise_right;
    const double gain = grip * r, d_gain = d_grip * r + grip * d_r;
    change->v = (gain * (d_right + d_left) + d_gain * (right + left)) / 2.0;
    change->omega = (gain * (d_right - d_left) + d_gain * (right - left) - robot->omega * d_L) / L;
}

/* With T, A_k = I + T (der by x, y, theta) is (31) and W_k = T (der by the wheels) is (32), columns left, right. */
void robot_tangent(const Robot *robot, const Robot *direction, bool starting, Robot *change) {
    *change = *direction;
    change->wheel_noise_left = change->wheel_noise_right = 0.0;
    change->x_meas = change->y_meas = change->theta_meas = 0.0;
    if (starting) {
        start_tangent(robot, direction, change);
    }
    speeds_tangent(robot, direction, change);
    const double c = cos(robot->theta), s = sin(robot->theta);
    change->der_x = change->v * c - robot->v * s * change->theta;
    change->der_y = change->v * s + robot->v * c * change->theta;
    change->der_theta = change->omega;
}
