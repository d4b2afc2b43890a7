#include "drive.h"

#include <math.h>

static const double LINK_TIMEOUT = 0.5; /* s without a fresh command before the robot stops */
static const double RAMP = 0.5;         /* s from there to standstill */

Drive drive_start(void) {
    return (Drive){.command_tick = NO_COMMAND};
}

void drive_follow(Drive *drive, uint32_t tick, int32_t stamp, double v, double omega) {
    if (stamp <= drive->command_tick || !isfinite(v) || !isfinite(omega)) {
        return;
    }
    drive->command_tick = stamp;
    drive->taken_at = tick;
    drive->asked_v = v;
    drive->asked_omega = omega;
}

void drive_supervise(Drive *drive, uint32_t tick) {
    const double silent = (tick - drive->taken_at) * SAMPLE_TIME;
    const double share = fmin(1.0, fmax(0.0, 1.0 - (silent - LINK_TIMEOUT) / RAMP));
    drive->v = share * drive->asked_v;
    drive->omega = share * drive->asked_omega;
}
