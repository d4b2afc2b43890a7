/* Which command the robot follows, tick by tick, and the failsafe that stops it without one. */
#ifndef DRIVE_H
#define DRIVE_H

#include <stdint.h>

#define SAMPLE_TIME 0.01 /* s */
#define NO_COMMAND (-1)

/* Speeds, and the stamp of the command that they come from; NO_COMMAND: standing still. */
typedef struct {
    double v, omega; /* m/s, rad/s */
    int32_t stamp;
} Command;

typedef struct {
    Command newest;
    uint32_t since;   /* the tick from which on the newest command counts */
    Command in_force; /* on [t_k, t_{k+1}) */
} Drive;

/* Standing still, until the first command. */
Drive drive_start(void);

/* A command comes into force at `tick`, unless it is stale or not finite. */
void drive_follow(Drive *drive, uint32_t tick, Command command);

/* What is in force from `tick` on: the newest command, or the way to a stop when it is too long ago. */
void drive_supervise(Drive *drive, uint32_t tick);

#endif
