#include "probe.h"

static const uint32_t LAGS[PROBE_PLACES] = {0, 16, 240}; /* as the dialect has them */
static const double FORGOTTEN = 1.0;                     /* s */

void probe_hear(Probing *probing, uint32_t session, uint32_t sequence, uint64_t time) {
    if (probing->running && session != probing->session && session != probing->session + 1) {
        return;
    }
    if (!probing->running || probing->session != session) {
        *probing = (Probing){.running = true, .session = session};
    }
    probing->came[probing->heard++ % PROBE_KEPT] = (Arrival){sequence, time};
    probing->silent = 0;
}

void probe_tell(Probing *probing, Arrival told[PROBE_PLACES]) {
    const uint32_t oldest = probing->heard > PROBE_KEPT ? probing->heard - PROBE_KEPT : 0;
    for (int i = 0; i < PROBE_PLACES; i++) {
        const uint32_t number = probing->next[i] > oldest ? probing->next[i] : oldest;
        told[i] = (Arrival){.sequence = PROBE_NONE};
        if (number + LAGS[i] < probing->heard) {
            told[i] = probing->came[number % PROBE_KEPT];
            probing->next[i] = number + 1;
        }
    }
    probing->said++;
}

void probe_wait(Probing *probing, double seconds) {
    probing->silent += seconds;
    if (probing->silent > FORGOTTEN) {
        probing->running = false;
    }
}
