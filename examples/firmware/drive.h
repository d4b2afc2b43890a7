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

#define PLAN_LONGEST 240 /* ticks */
#define PLAN_PIECE 15    /* of them in one frame */

/* A command, and the speeds that are to follow it, tick by tick, if nothing newer comes. */
typedef struct {
    Command command;
    uint16_t length;   /* how many follow */
    uint32_t in_force; /* the tick that the command is meant for, if any follow */
    double v[PLAN_LONGEST], omega[PLAN_LONGEST];
} Planned;

typedef struct {
    Planned newest;
    uint32_t since;   /* the last tick for which there was something fresh, or planned */
    Command in_force; /* on [t_k, t_{k+1}) */
} Drive;

/* Standing still, until the first command. */
Drive drive_start(void);

/* A command comes into force at `tick`, unless it is stale. */
void drive_follow(Drive *drive, uint32_t tick, const Planned *planned);

/* What is in force from `tick` on: the newest command, what it plans for that tick, or the way to a stop when there has
 * been neither for too long. */
void drive_supervise(Drive *drive, uint32_t tick);

#endif
