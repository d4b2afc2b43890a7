#include "body.h"

#include <math.h>

static const double POSITION_NOISE = 0.01; /* m, standard deviation */
static const double HEADING_NOISE = 0.01;  /* rad */

Body body_start(void) {
    return (Body){.pose = {.x = -3.0, .y = -3.0, .theta = 0.0}, .random_state = 1};
}

/* Eq. (3). */
void body_drive(Body *body, double v, double omega, double seconds) {
    Pose *pose = &body->pose;
    pose->x += seconds * v * cos(pose->theta);
    pose->y += seconds * v * sin(pose->theta);
    pose->theta += seconds * omega;
}

/* Uniform on (0, 1), by a linear congruential generator with Knuth's MMIX constants. */
static double uniform(Body *body) {
    body->random_state = body->random_state * 6364136223846793005u + 1442695040888963407u;
    return ((double)(body->random_state >> 11) + 0.5) / 9007199254740992.0;
}

/* Standard normal, by Box and Muller. */
static double normal(Body *body) {
    const double radius = sqrt(-2.0 * log(uniform(body)));
    return radius * cos(6.283185307179586 * uniform(body));
}

Pose body_measure(Body *body) {
    Pose seen = body->pose;
    seen.x += POSITION_NOISE * normal(body);
    seen.y += POSITION_NOISE * normal(body);
    seen.theta += HEADING_NOISE * normal(body);
    return seen;
}
