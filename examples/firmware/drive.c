#include "drive.h"

#include <math.h>

static const double LINK_TIMEOUT = 0.5; /* s without a fresh command before the robot stops */
static const double RAMP = 0.5;         /* s from there to standstill */

Drive drive_start(void) {
    const Command standing_still = {.stamp = NO_COMMAND};
    return (Drive){.newest = standing_still, .in_force = standing_still};
}

void drive_follow(Drive *drive, uint32_t tick, Command command) {
    if (command.stamp > drive->newest.stamp && isfinite(command.v) && isfinite(command.omega)) {
        drive->newest = command;
        drive->since = tick;
    }
}

void drive_supervise(Drive *drive, uint32_t tick) {
    const double silent = (tick - drive->since) * SAMPLE_TIME;
    const double share = fmin(1.0, fmax(0.0, 1.0 - (silent - LINK_TIMEOUT) / RAMP));
    drive->in_force = drive->newest;
    drive->in_force.v *= share;
    drive->in_force.omega *= share;
}
