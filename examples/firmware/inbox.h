/* The commands that have come, each with what it plans to follow it, until their time has come. */
#ifndef INBOX_H
#define INBOX_H

#include <stdbool.h>
#include <stdint.h>

#include "drive.h"

#define INBOX_SLOTS 64 /* ticks by which a command may be early, or its plan in pieces */

typedef struct {
    Planned planned;
    bool came;       /* the command itself; before it, pieces of its plan may be here */
    uint32_t pieces; /* a bit for each that is here */
} Slot;

typedef struct {
    Slot slots[INBOX_SLOTS]; /* the command stamped k in slot k modulo their number */
    uint32_t playout;        /* a command is followed so many ticks after its stamp, never later; 0: when it comes */
} Inbox;

/* Part of the plan of the command with this stamp: elements `first` and on. */
typedef struct {
    double v[PLAN_PIECE], omega[PLAN_PIECE];
    int32_t stamp;
    uint32_t in_force;
    uint16_t first;
} Piece;

/* Empty. */
void inbox_clear(Inbox *inbox);

/* A command came before `tick`, of which `length` further elements come in pieces; one that is not finite is nothing. */
void inbox_take_command(Inbox *inbox, uint32_t tick, Command command, uint16_t length);

void inbox_take_piece(Inbox *inbox, uint32_t tick, const Piece *piece);

/* The newest command that is whole and to be followed from `tick` on, or NULL; nothing that is older is given any more.
 * Asked at every tick. */
const Planned *inbox_due(Inbox *inbox, uint32_t tick);

#endif
