/* A robot in the plane: (3) of docs/theory.md, with noise of its drive (`drive.h`) and of its sensor on a grid of
 * samples. SI units, angles counter-clockwise. */
#ifndef LAGLAB_ROBOT_H
#define LAGLAB_ROBOT_H

#include <stdbool.h>

#include "model.h"

/* Puts the robot at its start pose, with sample 0 taken. Call again after changing parameters. */
void robot_start(Robot *robot);

/* Body speeds from the present inputs and the drive's noise in force; for the differential drive (1). */
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
