/* The laglab dialect as a robot speaks it, on mavgen's C code: bytes in, bytes out. */
#ifndef LINK_H
#define LINK_H

#include <stddef.h>
#include <stdint.h>

#include "body.h"
#include "drive.h"
#include "inbox.h"
#include "key.h"
#include "memory.h"
#include "probe.h"

#define LINK_LARGEST 280 /* bytes that link_write_* write at most */

/* What a station can ask of the robot. */
typedef struct {
    enum {
        LINK_NOTHING,
        LINK_REFUSED,
        LINK_BEGIN,
        LINK_SETTINGS,
        LINK_COMMAND,
        LINK_PLAN,
        LINK_REQUEST,
        LINK_RECALL,
        LINK_PROBE,
        LINK_END
    } kind;
    Command command;
    uint16_t length;            /* of the plan that belongs to a command */
    Piece piece;                /* of one */
    uint16_t request;           /* a MAV_CMD */
    uint32_t first;             /* the first tick to recall */
    uint16_t count;             /* ticks to recall */
    uint32_t session, sequence; /* of a probe */
    uint8_t reason;             /* of an end */
    const char *why;            /* a frame was refused for its signature */
} LinkEvent;

/* From now on sign all that is written, and take nothing that is not signed with this key. */
void link_sign(const uint8_t key[KEY_SIZE]);

/* What the time is now, as key_time has it: nothing is signed as if it were earlier. */
void link_clock(uint64_t now);

/* Take one byte, after link_next has given LINK_NOTHING. */
void link_take(uint8_t byte);

/* No byte has come for longer than a pause within a frame: what has begun will not be completed. */
void link_give_up(void);

/* What the bytes taken so far complete, one by one, then LINK_NOTHING. */
LinkEvent link_next(void);

/* The frames of one tick, in one piece: z_k with the command in force before it, and the tick, which counts the frames
 * before it in the piece. Their size. */
size_t link_write_tick(uint8_t *buffer, uint32_t tick, Pose seen, Command in_force, uint8_t before);

/* The answer to a request: this robot knows none. Its size. */
size_t link_write_refusal(uint8_t *buffer, uint16_t request);

/* The answer to a station that says what it was told; commands are played out so many ticks after their stamps, or not
 * at all (0). Its size. */
size_t link_write_settings(uint8_t *buffer, uint16_t playout);

/* The answer to a question of what was in force: LINK_RECALLED ticks from `first` on at most. Its size. */
#define LINK_RECALLED 12
size_t link_write_applied(uint8_t *buffer, const Memory *memory, uint32_t first, uint16_t count);

/* A probe, as long as a tick's frames, sent at this time of the wall's clock [ns]. Its size. */
size_t link_write_probe(uint8_t *buffer, Probing *probing, uint64_t now);

/* The answer to an end. Its size. */
size_t link_write_end(uint8_t *buffer, uint32_t tick, uint8_t reason);

#endif
