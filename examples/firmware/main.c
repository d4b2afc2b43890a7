/* A small robot on a serial port: `firmware [--speed F] [--key FILE] [--playout TICKS] DEVICE`. Its clock runs F times as
 * fast as the wall's; with a key it signs what it says, and hears nothing that is not signed; with a play-out it follows
 * each command so many ticks after its stamp, and none that comes later.
 *
 * It waits for a heartbeat, then ticks from 0 on, every SAMPLE_TIME of its own clock, until it is told to end. What
 * has been received by a tick comes into force at that tick. */
#define _DEFAULT_SOURCE

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "body.h"
#include "drive.h"
#include "inbox.h"
#include "key.h"
#include "link.h"
#include "memory.h"
#include "probe.h"

static const double PAUSE = 0.05; /* s; bytes of one frame come sooner after each other */

typedef struct {
    const char *device;
    int port;
    double wakes;        /* every so many seconds */
    double silent;       /* s since the last byte */
    const char *told[4]; /* why frames were refused */
    bool running;
    uint32_t tick;
    Body body;
    Drive drive;
    Inbox inbox;
    Memory memory;
    Probing probing;
    uint32_t asked; /* the next tick to recall */
    uint16_t owed;  /* so many from there on were asked for and not told yet */
} Robot;

/* Raw, 8N1, and without waiting: bytes come and go as they are. What came earlier is forgotten. */
static int open_port(const char *device) {
    const int port = open(device, O_RDWR | O_NOCTTY | O_NONBLOCK);
    struct termios settings;
    if (port < 0 || tcgetattr(port, &settings) != 0) {
        return -1;
    }
    cfmakeraw(&settings);
    cfsetspeed(&settings, B115200);
    return tcsetattr(port, TCSAFLUSH, &settings) == 0 ? port : -1;
}

/* By the wall's clock [ns]. */
static uint64_t wall_time(void) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

/* A tick that finds no room is dropped, as a UART would. */
static bool send(const Robot *robot, const uint8_t *data, size_t size) {
    return write(robot->port, data, size) >= 0 || errno == EAGAIN;
}

/* What is being told is told to its end, and what lies between it and what is asked now. */
static void owe(Robot *robot, uint32_t first, uint32_t count) {
    uint32_t end = first + count;
    if (robot->owed > 0) {
        const uint32_t end_of_owed = robot->asked + robot->owed;
        first = first < robot->asked ? first : robot->asked;
        end = end > end_of_owed ? end : end_of_owed;
    }
    robot->asked = first;
    robot->owed = (uint16_t)(end - first < MEMORY_TICKS ? end - first : MEMORY_TICKS);
}

/* Each reason once. */
static void tell(Robot *robot, const char *why) {
    size_t i = 0;
    while (i < sizeof robot->told / sizeof *robot->told - 1 && robot->told[i] && robot->told[i] != why) {
        i++;
    }
    if (robot->told[i] != why) {
        robot->told[i] = why;
        fprintf(stderr, "%s: frames refused: %s\n", robot->device, why);
    }
}

static bool obey(Robot *robot, LinkEvent event) {
    uint8_t buffer[LINK_LARGEST];
    switch (event.kind) {
        case LINK_REFUSED: tell(robot, event.why); return true;
        case LINK_REQUEST: return send(robot, buffer, link_write_refusal(buffer, event.request));
        case LINK_SETTINGS: return send(robot, buffer, link_write_settings(buffer, (uint16_t)robot->inbox.playout));
        case LINK_BEGIN:
            if (!robot->running) {
                robot->running = true;
                robot->tick = 0;
                robot->memory.ticks = 0;
                inbox_clear(&robot->inbox);
                robot->owed = 0;
            }
            return true;
        case LINK_RECALL: owe(robot, event.first, event.count < MEMORY_TICKS ? event.count : MEMORY_TICKS); return true;
        case LINK_PROBE: probe_hear(&robot->probing, event.session, event.sequence, wall_time()); return true;
        case LINK_COMMAND:
            if (robot->running) {
                inbox_take_command(&robot->inbox, robot->tick, event.command, event.length);
            }
            return true;
        case LINK_PLAN:
            if (robot->running) {
                inbox_take_piece(&robot->inbox, robot->tick, &event.piece);
            }
            return true;
        case LINK_END:
            robot->running = false;
            robot->drive = drive_start();
            return send(robot, buffer, link_write_end(buffer, robot->tick, event.reason));
        default: return true;
    }
}

static bool obey_all(Robot *robot) {
    LinkEvent event;
    while ((event = link_next()).kind != LINK_NOTHING) {
        if (!obey(robot, event)) {
            return false;
        }
    }
    return true;
}

/* All that has arrived; false when the far end is gone. */
static bool receive(Robot *robot) {
    uint8_t data[256];
    ssize_t size;
    robot->silent += robot->wakes;
    while ((size = read(robot->port, data, sizeof data)) > 0) {
        robot->silent = 0;
        for (ssize_t i = 0; i < size; i++) {
            link_take(data[i]);
            if (!obey_all(robot)) {
                return false;
            }
        }
    }
    const bool there = size < 0 && errno == EAGAIN;
    if (robot->silent > PAUSE) {
        link_give_up();
        return obey_all(robot) && there;
    }
    return there;
}

/* Some of what the station asked for: so many frames with each tick that the line has room for them. */
static size_t recall(Robot *robot, uint8_t *buffer) {
    if (robot->owed == 0) {
        return 0;
    }
    const size_t size = link_write_applied(buffer, &robot->memory, robot->asked, robot->owed);
    const uint16_t told = robot->owed < LINK_RECALLED ? robot->owed : LINK_RECALLED;
    robot->asked += told;
    robot->owed = (uint16_t)(robot->owed - told);
    return size;
}

/* Tick k: say where the robot is; the newest command comes into force; drive to k + 1. */
static bool tick(Robot *robot) {
    uint8_t buffer[2 * LINK_LARGEST];
    const Pose seen = body_measure(&robot->body);
    size_t size = recall(robot, buffer);
    size += link_write_tick(buffer + size, robot->tick, seen, robot->drive.in_force, size > 0 ? 2 : 1);
    const Planned *newest = inbox_due(&robot->inbox, robot->tick);
    if (newest) {
        drive_follow(&robot->drive, robot->tick, newest);
    }
    drive_supervise(&robot->drive, robot->tick);
    memory_keep(&robot->memory, robot->drive.in_force.v, robot->drive.in_force.omega);
    body_drive(&robot->body, robot->drive.in_force.v, robot->drive.in_force.omega, SAMPLE_TIME);
    robot->tick++;
    return send(robot, buffer, size);
}

/* While somebody measures the link, and no run goes on: a frame every tick. */
static bool probe(Robot *robot) {
    uint8_t buffer[LINK_LARGEST];
    probe_wait(&robot->probing, robot->wakes);
    if (robot->running || !robot->probing.running) {
        return true;
    }
    return send(robot, buffer, link_write_probe(buffer, &robot->probing, wall_time()));
}

/* Sleep until an instant that is `seconds` after the last one: being late once makes nothing late after it. */
static void sleep_on(struct timespec *deadline, double seconds) {
    deadline->tv_nsec += (long)(seconds * 1e9);
    deadline->tv_sec += deadline->tv_nsec / 1000000000L;
    deadline->tv_nsec %= 1000000000L;
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, deadline, NULL) == EINTR) {
    }
}

static void run(Robot *robot) {
    struct timespec deadline;
    clock_gettime(CLOCK_MONOTONIC, &deadline);
    link_clock(key_time());
    while (receive(robot) && (!robot->running || tick(robot)) && probe(robot)) {
        sleep_on(&deadline, robot->wakes);
        link_clock(key_time());
    }
}

typedef struct {
    double speed, playout;
    const char *key, *device;
} Options;

/* A whole argument as a number; what is none is not in any range. */
static double number_of(const char *argument) {
    char *end;
    const double number = strtod(argument, &end);
    return end == argument || *end ? NAN : number;
}

/* False when they are not as they must be. */
static bool read_options(int argc, char **argv, Options *options) {
    *options = (Options){.speed = 1.0};
    int i = 1;
    for (; i + 2 < argc; i += 2) {
        if (strcmp(argv[i], "--speed") == 0) {
            options->speed = number_of(argv[i + 1]);
        } else if (strcmp(argv[i], "--key") == 0) {
            options->key = argv[i + 1];
        } else if (strcmp(argv[i], "--playout") == 0) {
            options->playout = number_of(argv[i + 1]);
        } else {
            return false;
        }
    }
    options->device = argv[argc - 1];
    const bool speed = options->speed > 0 && options->speed <= 100;
    const bool playout = options->playout >= 0 && options->playout < INBOX_SLOTS && fmod(options->playout, 1.0) == 0;
    return i + 1 == argc && speed && playout;
}

int main(int argc, char **argv) {
    Options options;
    if (!read_options(argc, argv, &options)) {
        fprintf(stderr, "usage: %s [--speed F] [--key FILE] [--playout TICKS] DEVICE, F up to 100, TICKS below %d\n",
                argv[0], INBOX_SLOTS);
        return 2;
    }
    if (options.key) {
        uint8_t key[KEY_SIZE];
        const char *wrong = key_read(options.key, key);
        if (wrong) {
            fprintf(stderr, "%s: %s\n", options.key, wrong);
            return 2;
        }
        link_sign(key);
    }
    const char *device = options.device;
    Robot robot = {.device = device, .port = open_port(device), .body = body_start(), .drive = drive_start()};
    inbox_clear(&robot.inbox);
    robot.inbox.playout = (uint32_t)options.playout;
    robot.wakes = SAMPLE_TIME / options.speed;
    if (robot.port < 0) {
        fprintf(stderr, "%s: cannot open it as a serial port: %s\n", device, strerror(errno));
        return 1;
    }
    run(&robot);
    fprintf(stderr, "%s: the far end is gone\n", device);
    return 1;
}
