#include "link.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include <laglab/mavlink.h>

#if PLAN_PIECE != MAVLINK_MSG_LAGLAB_PLAN_FIELD_V_LEN || LINK_RECALLED != MAVLINK_MSG_LAGLAB_APPLIED_FIELD_V_LEN ||    \
    PROBE_PLACES != MAVLINK_MSG_LAGLAB_PROBE_FIELD_CAME_LEN
#error "the dialect's arrays have other lengths: change PLAN_PIECE, LINK_RECALLED or PROBE_PLACES"
#endif

enum { ROBOT_SYSTEM = 1, STATION_SYSTEM = 200, MINUTE = 6000000 };
#define ROBOT_COMPONENT MAV_COMP_ID_AUTOPILOT1
#define STATION_COMPONENT MAV_COMP_ID_MISSIONPLANNER

static const LinkEvent NOTHING = {.kind = LINK_NOTHING};

static bool is_for_us(uint8_t system, uint8_t component) {
    return system == ROBOT_SYSTEM && component == ROBOT_COMPONENT;
}

static LinkEvent command_of(const mavlink_message_t *message) {
    mavlink_laglab_command_t command;
    mavlink_msg_laglab_command_decode(message, &command);
    if (!is_for_us(command.target_system, command.target_component)) {
        return NOTHING;
    }
    return (LinkEvent){
        .kind = LINK_COMMAND, .command = {command.v, command.omega, (int32_t)command.tick}, .length = command.plan};
}

static LinkEvent plan_of(const mavlink_message_t *message) {
    mavlink_laglab_plan_t plan;
    mavlink_msg_laglab_plan_decode(message, &plan);
    if (!is_for_us(plan.target_system, plan.target_component)) {
        return NOTHING;
    }
    LinkEvent event = {.kind = LINK_PLAN};
    event.piece.stamp = (int32_t)plan.tick;
    event.piece.in_force = plan.in_force;
    event.piece.first = plan.first;
    memcpy(event.piece.v, plan.v, sizeof event.piece.v);
    memcpy(event.piece.omega, plan.omega, sizeof event.piece.omega);
    return event;
}

static LinkEvent request_of(uint8_t system, uint8_t component, uint16_t number) {
    const bool ours = is_for_us(system ? system : ROBOT_SYSTEM, component ? component : ROBOT_COMPONENT);
    return ours ? (LinkEvent){.kind = LINK_REQUEST, .request = number} : NOTHING;
}

static LinkEvent recall_of(const mavlink_message_t *message) {
    mavlink_laglab_recall_t asked;
    mavlink_msg_laglab_recall_decode(message, &asked);
    if (!is_for_us(asked.target_system, asked.target_component)) {
        return NOTHING;
    }
    return (LinkEvent){.kind = LINK_RECALL, .first = asked.first, .count = asked.count};
}

static LinkEvent probe_of(const mavlink_message_t *message) {
    return (LinkEvent){.kind = LINK_PROBE,
                       .session = mavlink_msg_laglab_probe_get_session(message),
                       .sequence = mavlink_msg_laglab_probe_get_sequence(message)};
}

static mavlink_signing_t signing;
static mavlink_signing_streams_t streams;
static uint64_t clock_now;

void link_sign(const uint8_t key[KEY_SIZE]) {
    mavlink_status_t *status = mavlink_get_channel_status(MAVLINK_COMM_0);
    memcpy(signing.secret_key, key, KEY_SIZE);
    signing.flags = MAVLINK_SIGNING_FLAG_SIGN_OUTGOING;
    status->signing = &signing;
    status->signing_streams = &streams;
}

void link_clock(uint64_t now) {
    clock_now = now;
    if (signing.timestamp < now) {
        signing.timestamp = now;
    }
}

static bool is_signed(const mavlink_message_t *message) {
    return message->incompat_flags & MAVLINK_IFLAG_SIGNED;
}

static bool have_key(void) {
    return mavlink_get_channel_status(MAVLINK_COMM_0)->signing != NULL;
}

/* What is signed for later than a minute from now would make all new streams too old, for good. */
static bool is_ahead(const mavlink_message_t *message) {
    uint64_t timestamp = 0;
    for (int i = 6; i > 0; i--) {
        timestamp = timestamp << 8 | message->signature[i];
    }
    return timestamp > clock_now + MINUTE;
}

static LinkEvent refused(const mavlink_message_t *message) {
    const char *why = "not signed with this key: give both sides the same --key";
    if (!is_signed(message)) {
        why = "not signed: give the sender the same --key";
    } else if (!have_key()) {
        why = "signed, and there is no key here to tell by whom: give --key here too";
    } else if (signing.last_status != MAVLINK_SIGNING_STATUS_BAD_SIGNATURE) {
        why = "signed too early or too late: set the clocks of both sides";
    }
    return (LinkEvent){.kind = LINK_REFUSED, .why = why};
}

static LinkEvent event_of(const mavlink_message_t *message) {
    if (message->magic != MAVLINK_STX || message->sysid != STATION_SYSTEM || message->compid != STATION_COMPONENT) {
        return NOTHING;
    }
    if (is_signed(message) && !have_key()) {
        return refused(message);
    }
    switch (message->msgid) {
        case MAVLINK_MSG_ID_HEARTBEAT: return (LinkEvent){.kind = LINK_BEGIN};
        case MAVLINK_MSG_ID_LAGLAB_SETTINGS: return (LinkEvent){.kind = LINK_SETTINGS};
        case MAVLINK_MSG_ID_LAGLAB_COMMAND: return command_of(message);
        case MAVLINK_MSG_ID_LAGLAB_PLAN: return plan_of(message);
        case MAVLINK_MSG_ID_LAGLAB_RECALL: return recall_of(message);
        case MAVLINK_MSG_ID_LAGLAB_PROBE: return probe_of(message);
        case MAVLINK_MSG_ID_COMMAND_LONG:
            return request_of(mavlink_msg_command_long_get_target_system(message),
                              mavlink_msg_command_long_get_target_component(message),
                              mavlink_msg_command_long_get_command(message));
        case MAVLINK_MSG_ID_COMMAND_INT:
            return request_of(mavlink_msg_command_int_get_target_system(message),
                              mavlink_msg_command_int_get_target_component(message),
                              mavlink_msg_command_int_get_command(message));
        case MAVLINK_MSG_ID_LAGLAB_END:
            return (LinkEvent){.kind = LINK_END, .reason = mavlink_msg_laglab_end_get_reason(message)};
        default: return NOTHING;
    }
}

/* The bytes from the start of what may be a frame on, and how many of them mavgen's parser has seen. On a false start
 * it would pass over as many bytes as the frame claims to have; so they are kept, and shown to it again. */
static uint8_t held[MAVLINK_MAX_PACKET_LEN];
static size_t holding, shown;

static void drop(size_t count) {
    memmove(held, held + count, holding - count);
    holding -= count;
    shown = 0;
}

void link_take(uint8_t byte) {
    held[holding++] = byte;
}

void link_give_up(void) {
    if (holding > 0) {
        mavlink_reset_channel_status(MAVLINK_COMM_0);
        drop(1);
    }
}

/* What has been said before, as it was before the frame that is being shown to the parser. */
static uint64_t timestamp_before;
static mavlink_signing_streams_t streams_before;

static uint8_t show_next(mavlink_message_t *message, mavlink_status_t *status) {
    if (shown == 0) {
        timestamp_before = signing.timestamp;
        streams_before = streams;
    }
    const uint8_t found = mavlink_frame_char(MAVLINK_COMM_0, held[shown++], message, status);
    if (found == MAVLINK_FRAMING_OK && have_key() && is_ahead(message)) {
        signing.timestamp = timestamp_before;
        streams = streams_before;
        return MAVLINK_FRAMING_BAD_SIGNATURE;
    }
    return found;
}

LinkEvent link_next(void) {
    mavlink_message_t message;
    mavlink_status_t status;
    while (shown < holding) {
        LinkEvent event = NOTHING;
        const uint8_t found = show_next(&message, &status);
        if (found == MAVLINK_FRAMING_OK) {
            drop(shown);
            event = event_of(&message);
        } else if (found != MAVLINK_FRAMING_INCOMPLETE || status.parse_state == MAVLINK_PARSE_STATE_IDLE) {
            mavlink_reset_channel_status(MAVLINK_COMM_0);
            drop(1);
            if (found == MAVLINK_FRAMING_BAD_SIGNATURE) {
                event = refused(&message);
            }
        }
        if (event.kind != LINK_NOTHING) {
            return event;
        }
    }
    return NOTHING;
}

size_t link_write_tick(uint8_t *buffer, uint32_t tick, Pose seen, Command in_force, uint8_t before) {
    mavlink_message_t message;
    mavlink_msg_laglab_measurement_pack(ROBOT_SYSTEM, ROBOT_COMPONENT, &message, seen.x, seen.y, seen.theta, in_force.v,
                                        in_force.omega, tick, in_force.stamp);
    const size_t size = mavlink_msg_to_send_buffer(buffer, &message);
    mavlink_msg_laglab_tick_pack(ROBOT_SYSTEM, ROBOT_COMPONENT, &message, tick, before);
    return size + mavlink_msg_to_send_buffer(buffer + size, &message);
}

size_t link_write_refusal(uint8_t *buffer, uint16_t request) {
    mavlink_message_t message;
    mavlink_msg_command_ack_pack(ROBOT_SYSTEM, ROBOT_COMPONENT, &message, request, MAV_RESULT_UNSUPPORTED, 0, 0,
                                 STATION_SYSTEM, STATION_COMPONENT);
    return mavlink_msg_to_send_buffer(buffer, &message);
}

/* What this robot knows of itself: it has no limits, follows any plan, and its link's delays are nothing that it could
 * know. */
size_t link_write_settings(uint8_t *buffer, uint16_t playout) {
    mavlink_message_t message;
    mavlink_msg_laglab_settings_pack(ROBOT_SYSTEM, ROBOT_COMPONENT, &message, SAMPLE_TIME, NAN, NAN, INFINITY, INFINITY,
                                     UINT16_MAX, UINT16_MAX, MAVLINK_VERSION, playout, UINT16_MAX, UINT16_MAX);
    return mavlink_msg_to_send_buffer(buffer, &message);
}

size_t link_write_applied(uint8_t *buffer, const Memory *memory, uint32_t first, uint16_t count) {
    double v[LINK_RECALLED] = {0}, omega[LINK_RECALLED] = {0};
    const uint8_t told = count < LINK_RECALLED ? (uint8_t)count : LINK_RECALLED;
    for (uint8_t i = 0; i < told; i++) {
        if (!memory_recall(memory, first + i, &v[i], &omega[i])) {
            v[i] = omega[i] = NAN;
        }
    }
    mavlink_message_t message;
    mavlink_msg_laglab_applied_pack(ROBOT_SYSTEM, ROBOT_COMPONENT, &message, v, omega, first, told);
    return mavlink_msg_to_send_buffer(buffer, &message);
}

size_t link_write_probe(uint8_t *buffer, Probing *probing, uint64_t now) {
    enum { UNFILLED = 68, SIGNATURE = 13, TICK_SIZE = 58 + 17 }; /* bytes of frames */
    const uint32_t interval = (uint32_t)(SAMPLE_TIME * 1e6);
    const uint32_t sequence = probing->said;
    uint8_t filler[MAVLINK_MSG_LAGLAB_PROBE_FIELD_FILLER_LEN] = {0};
    memset(filler, 1, TICK_SIZE - UNFILLED + (have_key() ? SIGNATURE : 0));
    Arrival told[PROBE_PLACES];
    probe_tell(probing, told);
    uint64_t came_ns[PROBE_PLACES];
    uint32_t came[PROBE_PLACES];
    for (int i = 0; i < PROBE_PLACES; i++) {
        came_ns[i] = told[i].time;
        came[i] = told[i].sequence;
    }
    mavlink_message_t message;
    mavlink_msg_laglab_probe_pack(ROBOT_SYSTEM, ROBOT_COMPONENT, &message, now, came_ns, probing->session, sequence,
                                  interval, came, filler);
    return mavlink_msg_to_send_buffer(buffer, &message);
}

size_t link_write_end(uint8_t *buffer, uint32_t tick, uint8_t reason) {
    mavlink_message_t message;
    mavlink_msg_laglab_end_pack(ROBOT_SYSTEM, ROBOT_COMPONENT, &message, tick, reason);
    return mavlink_msg_to_send_buffer(buffer, &message);
}
