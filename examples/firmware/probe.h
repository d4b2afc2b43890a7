/* The end of a link that is measured: what came when, and which of it is told next. */
#ifndef PROBE_H
#define PROBE_H

#include <stdbool.h>
#include <stdint.h>

#define PROBE_PLACES 3
#define PROBE_KEPT 480        /* arrivals */
#define PROBE_NONE UINT32_MAX /* told of no arrival */

/* A frame that came, and the time of the wall's clock [ns]. */
typedef struct {
    uint32_t sequence;
    uint64_t time;
} Arrival;

typedef struct {
    bool running;
    uint32_t session, said, heard;
    double silent; /* s since the last one came */
    Arrival came[PROBE_KEPT];
    uint32_t next[PROBE_PLACES]; /* by place: the number of the arrival that is told next */
} Probing;

/* A probe came; one of the next session begins anew, one of any other only when this one is over. */
void probe_hear(Probing *probing, uint32_t session, uint32_t sequence, uint64_t time);

/* What is told in the next probe, by place. */
void probe_tell(Probing *probing, Arrival told[PROBE_PLACES]);

/* So many seconds have passed: without a probe for long enough nobody measures any more. */
void probe_wait(Probing *probing, double seconds);

#endif
