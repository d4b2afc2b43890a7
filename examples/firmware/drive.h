/* Which command the robot follows, tick by tick, and the failsafe that stops it without one. */
#ifndef DRIVE_H
#define DRIVE_H

#include <stdint.h>

#define SAMPLE_TIME 0.01 /* s */
#define NO_COMMAND (-1)

typedef struct {
    double v, omega;      /* m/s, rad/s: in force on [t_k, t_{k+1}) */
    int32_t command_tick; /* the stamp of the command that they come from; NO_COMMAND: standing still */
    double asked_v, asked_omega;
    uint32_t taken_at; /* the tick at which that command came into force */
} Drive;

/* Standing still, until the first command. */
Drive drive_start(void);

/* A command stamped `stamp` comes into force at `tick`, unless it is stale or not finite. */
void drive_follow(Drive *drive, uint32_t tick, int32_t stamp, double v, double omega);

/* The speeds for `tick`: as commanded, or on the way to a stop when no fresh command has come for too long. */
void drive_supervise(Drive *drive, uint32_t tick);

#endif
