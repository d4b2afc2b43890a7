/* mavgen's parser, a byte at a time, and what it found last. */
#include <laglab/mavlink.h>

#include "export.h"

static mavlink_message_t found;

/* Whether a frame is whole with this byte. */
EXPORT int take(uint8_t byte) {
    mavlink_status_t status;
    return mavlink_parse_char(MAVLINK_COMM_0, byte, &found, &status);
}

EXPORT int message_id(void) {
    return (int)found.msgid;
}

EXPORT int system_id(void) {
    return found.sysid;
}

EXPORT int component_id(void) {
    return found.compid;
}

EXPORT int sequence(void) {
    return found.seq;
}

/* With the zeros that did not travel. */
EXPORT const void *payload(void) {
    return _MAV_PAYLOAD(&found);
}
