/* Variables by value reference. */
#include "instance.h"

#include <math.h>
#include <string.h>

#include "variables.h"

bool instance_has_type(uint32_t reference, Type type) {
    return reference < VARIABLES && VARIABLE[reference].type == type;
}

const Variable *instance_variable(const Instance *instance, Type type, uint32_t reference, const char *call) {
    if (instance_has_type(reference, type)) {
        return &VARIABLE[reference];
    }
    instance_log(instance, STATUS_ERROR, "%s: value reference %u (%s) is not a variable of this type", call,
                 (unsigned)reference, reference < VARIABLES ? VARIABLE[reference].name : "unknown");
    return NULL;
}

size_t instance_size(const Instance *instance, const Variable *variable) {
    return variable->role == ROLE_TIME || variable->role == ROLE_ROBOTS ? 1 : instance->robots;
}

static char *slot(const Robot *robot, const Variable *variable) {
    return (char *)robot + variable->offset;
}

Status instance_check_size(const Instance *instance, Type type, const uint32_t references[], size_t count, size_t size,
                           const char *call) {
    size_t expected = 0;
    for (size_t i = 0; i < count; i++) {
        const Variable *variable = instance_variable(instance, type, references[i], call);
        if (!variable) {
            return STATUS_ERROR;
        }
        expected += instance_size(instance, variable);
    }
    if (size != expected) {
        return instance_log(instance, STATUS_ERROR, "%s: %zu values given for variables that hold %zu", call, size,
                            expected);
    }
    return STATUS_OK;
}

static double *copy_floats(const Instance *instance, const Variable *variable, double *values) {
    if (variable->role == ROLE_TIME) {
        *values = instance->time;
        return values + 1;
    }
    const char *source = slot(instance->robot, variable);
    for (size_t k = 0; k < instance->robots; k++, source += sizeof(Robot)) {
        memcpy(values++, source, sizeof *values);
    }
    return values;
}

Status instance_check_value(const Instance *instance, const char *name, size_t robot, double value) {
    if (isfinite(value)) {
        return STATUS_OK;
    }
    return instance_log(instance, STATUS_ERROR, "%s of robot %zu is %g: its inputs or parameters are too large", name,
                        robot, value);
}

Status instance_check_finite(Instance *instance) {
    instance_refresh(instance);
    for (size_t k = 0; k < instance->robots; k++) {
        if (robot_is_finite(&instance->robot[k])) {
            continue;
        }
        for (size_t i = 0; i < VARIABLES; i++) {
            double value;
            memcpy(&value, slot(&instance->robot[k], &VARIABLE[i]), sizeof value);
            if (VARIABLE[i].role == ROLE_OUTPUT && !isfinite(value)) {
                return instance_check_value(instance, VARIABLE[i].name, k, value);
            }
        }
    }
    return STATUS_OK;
}

Status instance_get_floats(Instance *instance, const uint32_t references[], size_t count, double values[], size_t size,
                           const char *call) {
    const Status status = instance_check_size(instance, TYPE_FLOAT64, references, count, size, call);
    if (status != STATUS_OK) {
        return status;
    }
    instance_refresh(instance);
    for (size_t i = 0; i < count; i++) {
        const Variable *variable = &VARIABLE[references[i]];
        for (size_t k = 0; variable->role == ROLE_DERIVATIVE && k < instance->robots; k++) {
            robot_derivatives(&instance->robot[k]);
        }
        const double *first = values;
        values = copy_floats(instance, variable, values);
        for (const double *value = first; value < values; value++) {
            if (instance_check_value(instance, variable->name, (size_t)(value - first), *value) != STATUS_OK) {
                return STATUS_ERROR;
            }
        }
    }
    return STATUS_OK;
}

static Status check_settable(const Instance *instance, const Variable *variable, const char *call) {
    static const struct {
        int modes;
        const char *when;
    } ALLOWED[] = {
        [ROLE_PARAMETER] = {MODES_START, "before the simulation starts"},
        [ROLE_TUNABLE] = {MODES_START | MODE_EVENT | MODE_STEP | MODE_STEP_EVENT,
                          "before the start, at events and between steps"},
        [ROLE_INPUT] = {MODES_START | MODES_RUN, "before the simulation ends"},
        [ROLE_ROBOTS] = {MODE_CONFIGURATION, "in configuration mode"},
        [ROLE_DERIVATIVE] = {0, NULL},
    };
    const int modes = ALLOWED[variable->role].modes;
    if (!modes) {
        return instance_log(instance, STATUS_ERROR, "%s: %s cannot be set", call, variable->name);
    }
    if (!(instance->mode & modes)) {
        return instance_log(instance, STATUS_ERROR, "%s: %s cannot be set now, only %s", call, variable->name,
                            ALLOWED[variable->role].when);
    }
    return STATUS_OK;
}

static Status check_range(const Instance *instance, const Variable *variable, double value, const char *call) {
    if (!isfinite(value)) {
        return instance_log(instance, STATUS_DISCARD, "%s: %s = %g refused: it must be finite", call, variable->name,
                            value);
    }
    if (value >= variable->minimum && value <= variable->maximum) {
        return STATUS_OK;
    }
    return instance_log(instance, STATUS_DISCARD, "%s: %s = %g refused: it must be in [%g, %g]", call, variable->name,
                        value, variable->minimum, variable->maximum);
}

static Status check_floats(const Instance *instance, const uint32_t references[], size_t count, const double values[],
                           const char *call) {
    for (size_t i = 0; i < count; i++) {
        const Variable *variable = &VARIABLE[references[i]];
        Status status = check_settable(instance, variable, call);
        for (size_t k = 0; status == STATUS_OK && k < instance_size(instance, variable); k++) {
            status = check_range(instance, variable, *values++, call);
        }
        if (status != STATUS_OK) {
            return status;
        }
    }
    return STATUS_OK;
}

Status instance_set_floats(Instance *instance, const uint32_t references[], size_t count, const double values[],
                           size_t size, const char *call) {
    Status status = instance_check_size(instance, TYPE_FLOAT64, references, count, size, call);
    if (status == STATUS_OK) {
        status = check_floats(instance, references, count, values, call);
    }
    if (status != STATUS_OK) {
        return status;
    }
    for (size_t i = 0; i < count; i++) {
        char *target = slot(instance->robot, &VARIABLE[references[i]]);
        for (size_t k = 0; k < instance->robots; k++, target += sizeof(Robot)) {
            memcpy(target, values++, sizeof *values);
        }
    }
    instance->stale = true;
    return STATUS_OK;
}

int64_t instance_integer(const Instance *instance, const Variable *variable, size_t robot) {
    if (variable->role == ROLE_ROBOTS) {
        return (int64_t)instance->robots;
    }
    int64_t value;
    memcpy(&value, slot(&instance->robot[robot], variable), sizeof value);
    return value;
}

Status instance_check_integer(const Instance *instance, const Variable *variable, double value, const char *call) {
    const Status status = check_settable(instance, variable, call);
    return status == STATUS_OK ? check_range(instance, variable, value, call) : status;
}

Status instance_set_integer(Instance *instance, const Variable *variable, size_t robot, int64_t value) {
    if (variable->role == ROLE_ROBOTS) {
        return instance_configure(instance, (size_t)value);
    }
    memcpy(slot(&instance->robot[robot], variable), &value, sizeof value);
    instance->stale = true;
    return STATUS_OK;
}
