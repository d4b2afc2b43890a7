#include "robot.h"

#include <math.h>

#include "noise.h"

/* Two instants closer than this part of the sample time are the same instant, computed in two ways. */
static const double TIME_TOLERANCE = 1e-9;

enum { WHEEL_NOISE, MEASUREMENT_NOISE }; /* streams */

static double clamp(double value, double limit) {
    return value > limit ? limit : value < -limit ? -limit : value;
}

/* Speed of a wheel drive under command: a first-order lag, sampled; without a time constant it is the command. */
static double drive_speed(const Robot *robot, double reached, double commanded) {
    if (robot->wheel_speed_max > 0) {
        commanded = clamp(commanded, robot->wheel_speed_max);
    }
    if (robot->motor_time_constant > 0) {
        return commanded + (reached - commanded) * exp(-robot->sample_time / robot->motor_time_constant);
    }
    return commanded;
}

void robot_speeds(Robot *robot) {
    const double grip = 1.0 - robot->wheel_slip;
    const double r = robot->wheel_radius * (1.0 + robot->wheel_radius_error);
    const double L = robot->track * (1.0 + robot->track_error);
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

/* Draws the sample's noise. A variance of zero draws too, so that switching one noise off leaves the other as it was. */
static void draw(Robot *robot) {
    double w[2] = {0, 0}, v[3] = {0, 0, 0};
    if (robot->noise) {
        noise_normal((uint64_t)robot->seed, (uint64_t)robot->sample, WHEEL_NOISE, 2, w);
        noise_normal((uint64_t)robot->seed, (uint64_t)robot->sample, MEASUREMENT_NOISE, 3, v);
    }
    robot->wheel_noise_left = sqrt(robot->wheel_noise_variance) * w[0];
    robot->wheel_noise_right = sqrt(robot->wheel_noise_variance) * w[1];
    robot->x_meas = robot->x + sqrt(robot->measurement_variance_x) * v[0];
    robot->y_meas = robot->y + sqrt(robot->measurement_variance_y) * v[1];
    robot->theta_meas = robot->theta + sqrt(robot->measurement_variance_theta) * v[2];
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

void robot_step(Robot *robot, double step) {
    const double tolerance = TIME_TOLERANCE * robot->sample_time;
    while (step > tolerance) {
        const double to_sample = robot->sample_time - robot->elapsed;
        robot_speeds(robot);
        if (step < to_sample - tolerance) {
            move(robot, step);
            robot->elapsed += step;
            return;
        }
        move(robot, to_sample);
        robot_sample(robot);
        step -= to_sample;
    }
}
