#include "robot.h"

#include <math.h>
#include <string.h>

#include "drive.h"
#include "noise.h"

/* Two instants closer than this part of the sample time are the same instant, computed in two ways. */
static const double TIME_TOLERANCE = 1e-9;

enum { DRIVE_NOISE, MEASUREMENT_NOISE }; /* streams */

void robot_derivatives(Robot *robot) {
    robot->der_x = robot->v * cos(robot->theta);
    robot->der_y = robot->v * sin(robot->theta);
    robot->der_theta = robot->omega;
#ifdef DRIVE_SLIDES
    robot->der_x -= robot->sideways * sin(robot->theta);
    robot->der_y += robot->sideways * cos(robot->theta);
#endif
}

/* What a robot that can go sideways adds to a move. */
static void slide(Robot *robot, double T, double course) {
#ifdef DRIVE_SLIDES
    robot->x -= T * robot->sideways * sin(course);
    robot->y += T * robot->sideways * cos(course);
#else
    (void)robot, (void)T, (void)course;
#endif
}

/* (3) x <- x + T v cos theta, y <- y + T v sin theta, theta <- theta + T omega */
static void move_euler(Robot *robot, double T) {
    robot->x += T * robot->v * cos(robot->theta);
    robot->y += T * robot->v * sin(robot->theta);
    slide(robot, T, robot->theta);
    robot->theta += T * robot->omega;
}

/* Along the arc: a chord of length T v sin(a) / a in the direction theta + a, where a = T omega / 2. */
static void move_exact(Robot *robot, double T) {
    const double a = T * robot->omega / 2.0;
    const double chord = T * robot->v * (a != 0.0 ? sin(a) / a : 1.0);
    robot->x += chord * cos(robot->theta + a);
    robot->y += chord * sin(robot->theta + a);
    slide(robot, T * (a != 0.0 ? sin(a) / a : 1.0), robot->theta + a);
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
static void draw_normal(const Robot *robot, double w[DRIVE_NOISES], double v[3]) {
    memset(w, 0, DRIVE_NOISES * sizeof *w);
    memset(v, 0, 3 * sizeof *v);
    if (robot->noise) {
        noise_normal((uint64_t)robot->seed, (uint64_t)robot->sample, DRIVE_NOISE, DRIVE_NOISES, w);
        noise_normal((uint64_t)robot->seed, (uint64_t)robot->sample, MEASUREMENT_NOISE, 3, v);
    }
}

static void draw(Robot *robot) {
    double w[DRIVE_NOISES], v[3];
    draw_normal(robot, w, v);
    const double misread = robot->measurement_noise_gain;
    drive_shake(robot, w);
    robot->x_meas = robot->x + misread * (sqrt(robot->measurement_variance_x) * v[0]);
    robot->y_meas = robot->y + misread * (sqrt(robot->measurement_variance_y) * v[1]);
    robot->theta_meas = robot->theta + misread * (sqrt(robot->measurement_variance_theta) * v[2]);
}

void robot_start(Robot *robot) {
    robot->x = robot->x_start;
    robot->y = robot->y_start;
    robot->theta = robot->theta_start;
    drive_start(robot);
    robot->elapsed = 0.0;
    robot->sample = 0;
    draw(robot);
}

void robot_sample(Robot *robot) {
    drive_sample(robot);
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
    double w[DRIVE_NOISES], v[3];
    draw_normal(robot, w, v);
    const double misread = robot->measurement_noise_gain, d_misread = d->measurement_noise_gain;
    change->x = d->x_start;
    change->y = d->y_start;
    change->theta = d->theta_start;
    drive_shake_tangent(robot, d, w, change);
    change->x_meas =
        d->x_start + noise_tangent(misread, robot->measurement_variance_x, v[0], d_misread, d->measurement_variance_x);
    change->y_meas =
        d->y_start + noise_tangent(misread, robot->measurement_variance_y, v[1], d_misread, d->measurement_variance_y);
    change->theta_meas = d->theta_start + noise_tangent(misread, robot->measurement_variance_theta, v[2], d_misread,
                                                        d->measurement_variance_theta);
}

/* With T, A_k = I + T (der by x, y, theta) is (31) and W_k = T (der by the wheels) is (32), columns left, right. */
void robot_tangent(const Robot *robot, const Robot *direction, bool starting, Robot *change) {
    *change = *direction;
    drive_still(change);
    change->x_meas = change->y_meas = change->theta_meas = 0.0;
    if (starting) {
        start_tangent(robot, direction, change);
    }
    drive_tangent(robot, direction, change);
    const double c = cos(robot->theta), s = sin(robot->theta);
    change->der_x = change->v * c - robot->v * s * change->theta;
    change->der_y = change->v * s + robot->v * c * change->theta;
    change->der_theta = change->omega;
#ifdef DRIVE_SLIDES
    change->der_x -= change->sideways * s + robot->sideways * c * change->theta;
    change->der_y += change->sideways * c - robot->sideways * s * change->theta;
#endif
}
