/* The speeds that were in force at the last ticks, for a station that missed what told of them. */
#ifndef MEMORY_H
#define MEMORY_H

#include <stdbool.h>
#include <stdint.h>

#define MEMORY_TICKS 1024u

typedef struct {
    double v[MEMORY_TICKS], omega[MEMORY_TICKS]; /* m/s, rad/s; of tick k at k modulo MEMORY_TICKS */
    uint32_t ticks;                              /* so many have been kept, from tick 0 on */
} Memory;

/* What is in force on [t_k, t_{k+1}), k = 0, 1, 2, ... in order. */
void memory_keep(Memory *memory, double v, double omega);

/* Whether tick k is still known; if so its speeds. */
bool memory_recall(const Memory *memory, uint32_t tick, double *v, double *omega);

#endif
