/* Stands in for motors and odometry: on a real robot these two functions talk to the hardware. */
#ifndef BODY_H
#define BODY_H

#include <stdint.h>

typedef struct {
    double x, y, theta; /* m, m, rad */
} Pose;

typedef struct {
    Pose pose;
    uint64_t random_state;
} Body;

/* At rest where the shipped scenarios begin. */
Body body_start(void);

/* Drive for `seconds` at v [m/s] and omega [rad/s]. */
void body_drive(Body *body, double v, double omega, double seconds);

/* Where odometry sees the robot: its pose, and a little noise. */
Pose body_measure(Body *body);

#endif
