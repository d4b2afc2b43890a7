/* How fast mavgen's C is on the frames that bench.py sends: prints encode, decode, both signed [us]. */
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <laglab/mavlink.h>

enum { BLOCK = 2000, ROUNDS = 200, LONGEST = 80 };

static uint8_t frames[BLOCK][LONGEST];
static uint16_t sizes[BLOCK];
static mavlink_signing_t sender, receiver;
static mavlink_signing_streams_t streams;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void use_key(void)
{
    for (uint8_t i = 0; i < 32; i++)
        sender.secret_key[i] = receiver.secret_key[i] = i;
    sender.flags = MAVLINK_SIGNING_FLAG_SIGN_OUTGOING;
    sender.timestamp = 1;
    mavlink_get_channel_status(MAVLINK_COMM_0)->signing = &sender;
    mavlink_get_channel_status(MAVLINK_COMM_1)->signing = &receiver;
    mavlink_get_channel_status(MAVLINK_COMM_1)->signing_streams = &streams;
}

static double encode(void)
{
    mavlink_message_t message;
    const double started = now();
    for (int i = 0; i < BLOCK; i++) {
        mavlink_msg_laglab_measurement_pack(
            1, 1, &message, 1.5, -2.0, 3.125, 0.5, -1.7, 1234567, 1234537);
        sizes[i] = mavlink_msg_to_send_buffer(frames[i], &message);
    }
    return (now() - started) / BLOCK;
}

/* A negative time says that not every frame was delivered. */
static double decode(void)
{
    mavlink_message_t message;
    mavlink_status_t status;
    mavlink_laglab_measurement_t fields;
    double sum = 0;
    memset(&streams, 0, sizeof streams);
    receiver.timestamp = 0;
    const double started = now();
    for (int i = 0; i < BLOCK; i++)
        for (uint16_t j = 0; j < sizes[i]; j++)
            if (mavlink_parse_char(MAVLINK_COMM_1, frames[i][j], &message, &status)) {
                mavlink_msg_laglab_measurement_decode(&message, &fields);
                sum += fields.x;
            }
    const double taken = (now() - started) / BLOCK;
    return sum == 1.5 * BLOCK ? taken : -1;
}

static void measure(void)
{
    double encoding = 1, decoding = 1;
    for (int round = 0; round < ROUNDS; round++) {
        const double made = encode(), read = decode();
        encoding = made < encoding ? made : encoding;
        decoding = read < decoding ? read : decoding;
    }
    printf("%g\n%g\n", 1e6 * encoding, 1e6 * decoding);
}

int main(void)
{
    measure();
    use_key();
    measure();
    return 0;
}
