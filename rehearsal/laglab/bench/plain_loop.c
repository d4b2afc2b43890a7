/* The model without FMI: what a loop in C over robots costs. */
#include <stdlib.h>

#include "export.h"
#include "robot.h"
#include "variables.h"

enum { READINGS = 8 };

/* Robots of the default parameters, seeds 1, 2, ...; NULL without memory. */
EXPORT Robot *plain_start(size_t count) {
    Robot *robots = calloc(count, sizeof *robots);
    for (size_t i = 0; robots && i < count; i++) {
        Robot *robot = &robots[i];
        robot->wheel_radius = VARIABLE[VR_WHEEL_RADIUS].start;
        robot->track = VARIABLE[VR_TRACK].start;
        robot->sample_time = VARIABLE[VR_SAMPLE_TIME].start;
        robot->wheel_noise_variance = VARIABLE[VR_WHEEL_NOISE_VARIANCE].start;
        robot->measurement_variance_x = VARIABLE[VR_MEASUREMENT_VARIANCE_X].start;
        robot->measurement_variance_y = VARIABLE[VR_MEASUREMENT_VARIANCE_Y].start;
        robot->measurement_variance_theta = VARIABLE[VR_MEASUREMENT_VARIANCE_THETA].start;
        robot->wheel_noise_gain = robot->measurement_noise_gain = 1.0;
        robot->noise = 1;
        robot->integration = INTEGRATION_EULER;
        robot->seed = (int64_t)i + 1;
        robot_start(robot);
    }
    return robots;
}

/* Steps each robot `ticks` times: sets its wheel speeds, moves it, reads it. */
EXPORT void plain_loop(Robot *robots, size_t count, long ticks, const double speeds[][2], double readings[][READINGS]) {
    for (long tick = 0; tick < ticks; tick++) {
        for (size_t i = 0; i < count; i++) {
            Robot *robot = &robots[i];
            robot->omega_left = speeds[i][0];
            robot->omega_right = speeds[i][1];
            robot_step(robot, robot->sample_time);
            robot_speeds(robot);
            const double reading[READINGS] = {robot->x,      robot->y,          robot->theta, robot->x_meas,
                                              robot->y_meas, robot->theta_meas, robot->v,     robot->omega};
            for (int k = 0; k < READINGS; k++) {
                readings[i][k] = reading[k];
            }
        }
    }
}

EXPORT void plain_end(Robot *robots) {
    free(robots);
}
