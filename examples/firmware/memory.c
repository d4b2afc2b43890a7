#include "memory.h"

void memory_keep(Memory *memory, double v, double omega) {
    const uint32_t place = memory->ticks++ % MEMORY_TICKS;
    memory->v[place] = v;
    memory->omega[place] = omega;
}

bool memory_recall(const Memory *memory, uint32_t tick, double *v, double *omega) {
    if (tick >= memory->ticks || memory->ticks - tick > MEMORY_TICKS) {
        return false;
    }
    *v = memory->v[tick % MEMORY_TICKS];
    *omega = memory->omega[tick % MEMORY_TICKS];
    return true;
}
