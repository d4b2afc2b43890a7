#include "link.h"

#include <laglab/mavlink.h>

enum { ROBOT_SYSTEM = 1, STATION_SYSTEM = 200 };
#define ROBOT_COMPONENT MAV_COMP_ID_AUTOPILOT1
#define STATION_COMPONENT MAV_COMP_ID_MISSIONPLANNER

static LinkEvent command_of(const mavlink_message_t *message) {
    mavlink_laglab_command_t command;
    mavlink_msg_laglab_command_decode(message, &command);
    if (command.target_system != ROBOT_SYSTEM || command.target_component != ROBOT_COMPONENT) {
        return (LinkEvent){.kind = LINK_NOTHING};
    }
    return (LinkEvent){.kind = LINK_COMMAND, .command = {command.v, command.omega, (int32_t)command.tick}};
}

LinkEvent link_read(uint8_t byte) {
    mavlink_message_t message;
    mavlink_status_t status;
    const LinkEvent nothing = {.kind = LINK_NOTHING};
    if (!mavlink_parse_char(MAVLINK_COMM_0, byte, &message, &status)) {
        return nothing;
    }
    if (message.sysid != STATION_SYSTEM || message.compid != STATION_COMPONENT) {
        return nothing;
    }
    switch (message.msgid) {
    case MAVLINK_MSG_ID_HEARTBEAT:
        return (LinkEvent){.kind = LINK_BEGIN};
    case MAVLINK_MSG_ID_LAGLAB_COMMAND:
        return command_of(&message);
    case MAVLINK_MSG_ID_LAGLAB_END:
        return (LinkEvent){.kind = LINK_END, .reason = mavlink_msg_laglab_end_get_reason(&message)};
    default:
        return nothing;
    }
}

size_t link_write_tick(uint8_t *buffer, uint32_t tick, Pose seen, Command in_force) {
    mavlink_message_t message;
    mavlink_msg_laglab_measurement_pack(ROBOT_SYSTEM, ROBOT_COMPONENT, &message, seen.x, seen.y, seen.theta,
                                        in_force.v, in_force.omega, tick, in_force.stamp);
    const size_t size = mavlink_msg_to_send_buffer(buffer, &message);
    mavlink_msg_laglab_tick_pack(ROBOT_SYSTEM, ROBOT_COMPONENT, &message, tick, 1);
    return size + mavlink_msg_to_send_buffer(buffer + size, &message);
}

size_t link_write_end(uint8_t *buffer, uint32_t tick, uint8_t reason) {
    mavlink_message_t message;
    mavlink_msg_laglab_end_pack(ROBOT_SYSTEM, ROBOT_COMPONENT, &message, tick, reason);
    return mavlink_msg_to_send_buffer(buffer, &message);
}
