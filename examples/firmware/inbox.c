#include "inbox.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Ticks: what is stamped further ahead is no answer to anything that was said here. */
#define FURTHEST_AHEAD 256u

void inbox_clear(Inbox *inbox) {
    for (size_t i = 0; i < INBOX_SLOTS; i++) {
        inbox->slots[i] = (Slot){.planned.command.stamp = NO_COMMAND};
    }
}

/* NULL where something newer is in its place, and for what answers a tick that is far from come: it would be the
 * newest for long, and keep all others out. */
static Slot *slot_of(Inbox *inbox, uint32_t tick, int32_t stamp) {
    if (stamp < 0 || (uint32_t)stamp > tick + FURTHEST_AHEAD) {
        return NULL;
    }
    Slot *slot = &inbox->slots[stamp % INBOX_SLOTS];
    if (slot->planned.command.stamp < stamp) {
        *slot = (Slot){.planned.command.stamp = stamp};
    }
    return slot->planned.command.stamp == stamp ? slot : NULL;
}

static uint32_t played_out(const Inbox *inbox, const Slot *slot) {
    return (uint32_t)slot->planned.command.stamp + inbox->playout;
}

/* It stays in its slot, so that nothing older is taken in its place. */
static void done_with(Slot *slot) {
    slot->came = false;
    slot->pieces = 0;
}

static bool is_whole(const Slot *slot) {
    const uint32_t count = ((uint32_t)slot->planned.length + PLAN_PIECE - 1) / PLAN_PIECE;
    const uint32_t all = (1u << count) - 1;
    return slot->came && (slot->pieces & all) == all;
}

static void drop_if_late(const Inbox *inbox, Slot *slot, uint32_t tick) {
    if (inbox->playout > 0 && is_whole(slot) && tick > played_out(inbox, slot)) {
        done_with(slot);
    }
}

void inbox_take_command(Inbox *inbox, uint32_t tick, Command command, uint16_t length) {
    const bool sound = length <= PLAN_LONGEST && isfinite(command.v) && isfinite(command.omega);
    Slot *slot = sound ? slot_of(inbox, tick, command.stamp) : NULL;
    if (!slot || slot->came) {
        return;
    }
    slot->planned.command = command;
    slot->planned.length = length;
    slot->came = true;
    drop_if_late(inbox, slot, tick);
}

static bool is_sound(const Piece *piece) {
    bool finite = true;
    for (size_t i = 0; i < PLAN_PIECE; i++) {
        finite = finite && isfinite(piece->v[i]) && isfinite(piece->omega[i]);
    }
    return finite && piece->first > 0 && piece->first <= PLAN_LONGEST && (piece->first - 1) % PLAN_PIECE == 0;
}

void inbox_take_piece(Inbox *inbox, uint32_t tick, const Piece *piece) {
    Slot *slot = is_sound(piece) ? slot_of(inbox, tick, piece->stamp) : NULL;
    if (!slot) {
        return;
    }
    const size_t start = piece->first - 1u;
    memcpy(&slot->planned.v[start], piece->v, sizeof piece->v);
    memcpy(&slot->planned.omega[start], piece->omega, sizeof piece->omega);
    slot->planned.in_force = piece->in_force;
    slot->pieces |= 1u << start / PLAN_PIECE;
    drop_if_late(inbox, slot, tick);
}

static bool is_due(const Inbox *inbox, const Slot *slot, uint32_t tick) {
    const bool planned_for_later = slot->planned.length > 0 && slot->planned.in_force > tick;
    return !planned_for_later && (inbox->playout == 0 || played_out(inbox, slot) <= tick);
}

const Planned *inbox_due(Inbox *inbox, uint32_t tick) {
    Slot *newest = NULL;
    for (size_t i = 0; i < INBOX_SLOTS; i++) {
        Slot *slot = &inbox->slots[i];
        const bool newer = !newest || slot->planned.command.stamp > newest->planned.command.stamp;
        if (is_whole(slot) && newer && is_due(inbox, slot, tick)) {
            newest = slot;
        }
    }
    if (!newest) {
        return NULL;
    }
    for (size_t i = 0; i < INBOX_SLOTS; i++) {
        if (inbox->slots[i].planned.command.stamp <= newest->planned.command.stamp) {
            done_with(&inbox->slots[i]);
        }
    }
    return &newest->planned;
}
