/* The laglab dialect as a robot speaks it, on mavgen's C code: bytes in, bytes out. */
#ifndef LINK_H
#define LINK_H

#include <stddef.h>
#include <stdint.h>

#include "body.h"
#include "drive.h"

#define LINK_LARGEST 128 /* bytes that link_write_* write at most */

/* What a station can ask of the robot. */
typedef struct {
    enum { LINK_NOTHING, LINK_BEGIN, LINK_COMMAND, LINK_END } kind;
    Command command;
    uint8_t reason; /* of an end */
} LinkEvent;

/* Take one byte; what it completes, mostly nothing. */
LinkEvent link_read(uint8_t byte);

/* The frames of one tick, in one piece: z_k with the command in force before it, and the tick. Their size. */
size_t link_write_tick(uint8_t *buffer, uint32_t tick, Pose seen, Command in_force);

/* The answer to an end. Its size. */
size_t link_write_end(uint8_t *buffer, uint32_t tick, uint8_t reason);

#endif
