#include "drive.h"

#include <math.h>

static const double LINK_TIMEOUT = 0.5; /* s without a fresh command before the robot stops */
static const double RAMP = 0.5;         /* s from there to standstill */

Drive drive_start(void) {
    const Command standing_still = {.stamp = NO_COMMAND};
    return (Drive){.newest.command = standing_still, .in_force = standing_still};
}

void drive_follow(Drive *drive, uint32_t tick, const Planned *planned) {
    if (planned->command.stamp > drive->newest.command.stamp) {
        const uint32_t runs_out = planned->length > 0 ? planned->in_force + planned->length : tick;
        drive->newest = *planned;
        drive->since = runs_out > tick ? runs_out : tick;
    }
}

/* What the newest command has for a tick; the last that it has for all that come after. */
static Command read_off(const Planned *newest, uint32_t tick) {
    Command command = newest->command;
    if (newest->length > 0 && tick > newest->in_force) {
        const uint32_t ahead = tick - newest->in_force;
        const uint32_t element = ahead < newest->length ? ahead : newest->length;
        command.v = newest->v[element - 1];
        command.omega = newest->omega[element - 1];
    }
    return command;
}

void drive_supervise(Drive *drive, uint32_t tick) {
    const double silent = tick > drive->since ? (tick - drive->since) * SAMPLE_TIME : 0.0;
    const double share = fmin(1.0, fmax(0.0, 1.0 - (silent - LINK_TIMEOUT) / RAMP));
    drive->in_force = read_off(&drive->newest, tick);
    drive->in_force.v *= share;
    drive->in_force.omega *= share;
}
