#include "instance.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "variables.h"

static const struct {
    const char *name;
    unsigned bit;
    Status status;
} CATEGORY[] = {
    {"logEvents", LOG_EVENTS, STATUS_OK},
    {"logStatusDiscard", LOG_DISCARD, STATUS_DISCARD},
    {"logStatusError", LOG_ERROR, STATUS_ERROR},
};
enum { CATEGORIES = sizeof CATEGORY / sizeof CATEGORY[0] };

Status instance_log(const Instance *instance, Status status, const char *format, ...) {
    for (size_t i = 0; i < CATEGORIES; i++) {
        if (CATEGORY[i].status != status || !(instance->logged & CATEGORY[i].bit) || !instance->callback) {
            continue;
        }
        char message[MESSAGE_SIZE];
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(message, sizeof message, format, arguments);
        va_end(arguments);
        instance->log(instance, status, CATEGORY[i].name, message);
    }
    return status;
}

Status instance_set_logging(Instance *instance, bool on, size_t count, const char *const categories[]) {
    unsigned bits = count ? 0 : LOG_EVENTS | LOG_DISCARD | LOG_ERROR;
    for (size_t i = 0; i < count; i++) {
        unsigned bit = 0;
        for (size_t k = 0; k < CATEGORIES; k++) {
            if (categories && categories[i] && strcmp(categories[i], CATEGORY[k].name) == 0) {
                bit = CATEGORY[k].bit;
            }
        }
        if (!bit) {
            return instance_log(instance, STATUS_ERROR, "log category %zu is not one of the model description's", i);
        }
        bits |= bit;
    }
    instance->logged = on ? instance->logged | bits : instance->logged & ~bits;
    return STATUS_OK;
}

bool instance_allows(const Instance *instance, int modes, const char *call) {
    static const struct {
        Mode mode;
        const char *name;
    } NAME[] = {{MODE_INSTANTIATED, "instantiated"},
                {MODE_CONFIGURATION, "configuration mode"},
                {MODE_INITIALIZATION, "initialization mode"},
                {MODE_EVENT, "event mode"},
                {MODE_CONTINUOUS_TIME, "continuous-time mode"},
                {MODE_STEP, "step mode"},
                {MODE_STEP_EVENT, "event mode"},
                {MODE_INTERMEDIATE, "intermediate update mode"},
                {MODE_TERMINATED, "terminated"}};
    if (instance->mode & modes) {
        return true;
    }
    for (size_t i = 0; i < sizeof NAME / sizeof NAME[0]; i++) {
        if (NAME[i].mode == instance->mode) {
            instance_log(instance, STATUS_ERROR, "%s is not allowed when the instance is %s%s", call,
                         strstr(NAME[i].name, "mode") ? "in " : "", NAME[i].name);
        }
    }
    return false;
}

static void set_defaults(Robot *robot, int64_t index) {
    memset(robot, 0, sizeof *robot);
    for (size_t i = 0; i < VARIABLES; i++) {
        const Variable *variable = &VARIABLE[i];
        const int64_t whole = (int64_t)variable->start;
        if (is_settable(variable)) {
            memcpy((char *)robot + variable->offset,
                   variable->type == TYPE_FLOAT64 ? (const void *)&variable->start : &whole, 8);
        }
    }
    robot->seed += index; /* robots of a fleet differ unless told otherwise */
}

Status instance_configure(Instance *instance, size_t robots) {
    Robot *robot = robots <= SIZE_MAX / sizeof *robot ? malloc(robots * sizeof *robot) : NULL;
    Robot *before = robot ? malloc(robots * sizeof *before) : NULL;
    if (!before) {
        free(robot);
        return instance_log(instance, STATUS_ERROR, "robots: no memory for %zu robots", robots);
    }
    free(instance->robot);
    free(instance->before);
    instance->robot = robot;
    instance->before = before;
    instance->robots = robots;
    instance->stale = true;
    for (size_t i = 0; i < robots; i++) {
        set_defaults(&robot[i], (int64_t)i);
    }
    return STATUS_OK;
}

Status instance_reset(Instance *instance) {
    instance->mode = MODE_INSTANTIATED;
    instance->start_time = instance->time = 0.0;
    instance->stop_time = INFINITY;
    return instance_configure(instance, (size_t)VARIABLE[VR_ROBOTS].start);
}

Instance *instance_new(const Instance *draft, const char *name, const char *token, bool debug) {
    Instance *instance = calloc(1, sizeof *instance);
    if (!instance) {
        return NULL;
    }
    *instance = *draft;
    instance->logged = LOG_DISCARD | LOG_ERROR | (debug ? LOG_EVENTS : 0);
    instance->name = calloc(1, name ? strlen(name) + 1 : 1);
    if (!instance->name || instance_reset(instance) != STATUS_OK) {
        instance_free(instance);
        return NULL;
    }
    strcpy(instance->name, name ? name : "");
    for (const char *const *own = instance->tokens; token && *own; own++) {
        if (strcmp(token, *own) == 0) {
            return instance;
        }
    }
    instance_log(instance, STATUS_ERROR, "instantiation token is %s; this binary belongs to %s", token ? token : "NULL",
                 instance->tokens[0]);
    instance_free(instance);
    return NULL;
}

void instance_free(Instance *instance) {
    if (instance) {
        free(instance->robot);
        free(instance->before);
        free(instance->name);
        free(instance);
    }
}

void instance_refresh(Instance *instance) {
    if (!instance->stale) {
        return;
    }
    for (size_t i = 0; i < instance->robots; i++) {
        if (instance->mode & (MODES_START | MODE_CONFIGURATION)) {
            robot_start(&instance->robot[i]);
        }
        robot_speeds(&instance->robot[i]);
    }
    instance->stale = false;
}

Status instance_set_experiment(Instance *instance, double start_time, double stop_time) {
    if (!isfinite(start_time)) {
        return instance_log(instance, STATUS_ERROR, "startTime is %g, not a finite time", start_time);
    }
    if (!(start_time <= stop_time)) {
        return instance_log(instance, STATUS_ERROR, "startTime %g s is not before stopTime, %g s", start_time,
                            stop_time);
    }
    instance->start_time = start_time;
    instance->stop_time = stop_time;
    return STATUS_OK;
}

Status instance_enter_initialization(Instance *instance) {
    instance->time = instance->start_time;
    instance->mode = MODE_INITIALIZATION;
    instance_log(instance, STATUS_OK, "initializing %zu robot(s) at time %g s", instance->robots, instance->time);
    return STATUS_OK;
}
