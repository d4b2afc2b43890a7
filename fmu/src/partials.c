/* Directional and adjoint derivatives, robot by robot: robots do not depend on each other. */
#include <math.h>
#include <string.h>

#include "instance.h"
#include "variables.h"

static bool is_starting(const Instance *instance) {
    return instance->mode == MODE_INITIALIZATION;
}

/* At the start the pose follows from parameters; later these are fixed, and what they say is in the pose. */
static bool is_known(const Instance *instance, uint32_t reference) {
    if (!instance_has_type(reference, TYPE_FLOAT64)) {
        return false;
    }
    const bool state = reference == VR_X || reference == VR_Y || reference == VR_THETA;
    return is_starting(instance) ? is_settable(&VARIABLE[reference]) : state || VARIABLE[reference].role == ROLE_INPUT;
}

static bool is_unknown(uint32_t reference) {
    return instance_has_type(reference, TYPE_FLOAT64) &&
           (VARIABLE[reference].role == ROLE_OUTPUT || VARIABLE[reference].role == ROLE_DERIVATIVE);
}

static Status refuse(const Instance *instance, uint32_t reference, const char *what, const char *call) {
    return instance_log(instance, STATUS_ERROR, "%s: value reference %u (%s) is not %s", call, (unsigned)reference,
                        reference < VARIABLES ? VARIABLE[reference].name : "unknown", what);
}

static Status check(const Instance *instance, const Partials *partials, const char *call) {
    for (size_t i = 0; i < partials->unknown_count; i++) {
        if (!is_unknown(partials->unknowns[i])) {
            return refuse(instance, partials->unknowns[i], "an output or a state derivative", call);
        }
    }
    for (size_t i = 0; i < partials->known_count; i++) {
        if (!is_known(instance, partials->knowns[i])) {
            return refuse(instance, partials->knowns[i],
                          is_starting(instance) ? "an input or a real parameter" : "an input or a state", call);
        }
    }
    return STATUS_OK;
}

static double *field(Robot *robot, uint32_t reference) {
    return (double *)((char *)robot + VARIABLE[reference].offset);
}

static Status check_change(const Instance *instance, uint32_t reference, double change, const char *call) {
    if (isfinite(change)) {
        return STATUS_OK;
    }
    return instance_log(instance, STATUS_ERROR, "%s: the derivative of %s is %g here", call, VARIABLE[reference].name,
                        change);
}

Status instance_directional(Instance *instance, const Partials *partials, const double seed[], double sensitivity[],
                            const char *call) {
    Status status = check(instance, partials, call);
    instance_refresh(instance);
    for (size_t k = 0; status == STATUS_OK && k < instance->robots; k++) {
        Robot direction = {0}, change;
        for (size_t i = 0; i < partials->known_count; i++) {
            *field(&direction, partials->knowns[i]) += seed[i * instance->robots + k];
        }
        robot_tangent(&instance->robot[k], &direction, is_starting(instance), &change);
        for (size_t i = 0; status == STATUS_OK && i < partials->unknown_count; i++) {
            const double value = *field(&change, partials->unknowns[i]);
            sensitivity[i * instance->robots + k] = value;
            status = check_change(instance, partials->unknowns[i], value, call);
        }
    }
    return status;
}

Status instance_adjoint(Instance *instance, const Partials *partials, const double seed[], double sensitivity[],
                        const char *call) {
    Status status = check(instance, partials, call);
    instance_refresh(instance);
    for (size_t k = 0; status == STATUS_OK && k < instance->robots; k++) {
        for (size_t i = 0; status == STATUS_OK && i < partials->known_count; i++) {
            Robot direction = {0}, change;
            *field(&direction, partials->knowns[i]) = 1.0;
            robot_tangent(&instance->robot[k], &direction, is_starting(instance), &change);
            double sum = 0.0;
            for (size_t j = 0; j < partials->unknown_count; j++) {
                sum += *field(&change, partials->unknowns[j]) * seed[j * instance->robots + k];
            }
            sensitivity[i * instance->robots + k] = sum;
            status = check_change(instance, partials->knowns[i], sum, call);
        }
    }
    return status;
}
