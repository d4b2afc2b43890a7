/* mavgen's C on the frames that codec.py sends: a block of messages a call, unsigned or signed. */
#include <string.h>
#include <laglab/mavlink.h>

#include "export.h"

enum { MOST = 4096, LONGEST = 80 };
enum { SENDER = MAVLINK_COMM_0, RECEIVER = MAVLINK_COMM_1, SIGNING_SENDER = MAVLINK_COMM_2, VERIFIER = MAVLINK_COMM_3 };

static uint8_t frames[2][MOST][LONGEST];
static uint16_t sizes[2][MOST];
static mavlink_signing_t sender, verifier;
static mavlink_signing_streams_t streams;

EXPORT void use_key(const uint8_t key[32]) {
    memcpy(sender.secret_key, key, 32);
    memcpy(verifier.secret_key, key, 32);
    sender.flags = MAVLINK_SIGNING_FLAG_SIGN_OUTGOING;
    sender.timestamp = 1;
    mavlink_get_channel_status(SIGNING_SENDER)->signing = &sender;
    mavlink_get_channel_status(VERIFIER)->signing = &verifier;
    mavlink_get_channel_status(VERIFIER)->signing_streams = &streams;
}

/* Makes `count` frames, MOST at most, and keeps them. */
EXPORT void encode(int count, int with_key) {
    mavlink_message_t message;
    const uint8_t channel = with_key ? SIGNING_SENDER : SENDER;
    for (int i = 0; i < count; i++) {
        mavlink_msg_laglab_measurement_pack_chan(1, 1, channel, &message, 1.5, -2.0, 3.125, 0.5, -1.7, 1234567,
                                                 1234537);
        sizes[with_key][i] = mavlink_msg_to_send_buffer(frames[with_key][i], &message);
    }
}

/* Reads the frames that were made last; returns how many were delivered whole. */
EXPORT int decode(int count, int with_key) {
    mavlink_message_t message;
    mavlink_status_t status;
    mavlink_laglab_measurement_t fields;
    const uint8_t channel = with_key ? VERIFIER : RECEIVER;
    int delivered = 0;
    memset(&streams, 0, sizeof streams);
    verifier.timestamp = 0;
    for (int i = 0; i < count; i++) {
        for (uint16_t j = 0; j < sizes[with_key][i]; j++) {
            if (mavlink_parse_char(channel, frames[with_key][i][j], &message, &status)) {
                mavlink_msg_laglab_measurement_decode(&message, &fields);
                delivered += fields.x == 1.5;
            }
        }
    }
    return delivered;
}
