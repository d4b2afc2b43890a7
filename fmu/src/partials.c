/* Directional and adjoint derivatives, robot by robot: robots do not depend on each other. */
#include "instance.h"
#include "variables.h"

enum { NOT_ONE = -1 };

static int known_column(uint32_t reference) {
    switch (reference) {
        case VR_X: return BY_X;
        case VR_Y: return BY_Y;
        case VR_THETA: return BY_THETA;
        case VR_OMEGA_LEFT: return BY_OMEGA_LEFT;
        case VR_OMEGA_RIGHT: return BY_OMEGA_RIGHT;
        default: return NOT_ONE;
    }
}

static int unknown_row(uint32_t reference) {
    switch (reference) {
        case VR_X: return OF_X;
        case VR_Y: return OF_Y;
        case VR_THETA: return OF_THETA;
        case VR_V: return OF_V;
        case VR_OMEGA: return OF_OMEGA;
        case VR_DER_X: return OF_DER_X;
        case VR_DER_Y: return OF_DER_Y;
        case VR_DER_THETA: return OF_DER_THETA;
        case VR_X_MEAS:
        case VR_Y_MEAS:
        case VR_THETA_MEAS: return OF_SAMPLED;
        default: return NOT_ONE;
    }
}

static Status refuse(const Instance *instance, uint32_t reference, const char *what, const char *call) {
    return instance_log(instance, STATUS_ERROR, "%s: value reference %u (%s) is not %s", call, (unsigned)reference,
                        reference < VARIABLES ? VARIABLE[reference].name : "unknown", what);
}

static Status check(const Instance *instance, const Partials *partials, const char *call) {
    for (size_t i = 0; i < partials->unknown_count; i++) {
        if (unknown_row(partials->unknowns[i]) == NOT_ONE) {
            return refuse(instance, partials->unknowns[i], "an output or a state derivative", call);
        }
    }
    for (size_t i = 0; i < partials->known_count; i++) {
        if (known_column(partials->knowns[i]) == NOT_ONE) {
            return refuse(instance, partials->knowns[i], "an input or a state", call);
        }
    }
    return STATUS_OK;
}

Status instance_directional(Instance *instance, const Partials *partials, const double seed[], double sensitivity[],
                            const char *call) {
    if (check(instance, partials, call) != STATUS_OK) {
        return STATUS_ERROR;
    }
    instance_refresh(instance);
    for (size_t robot = 0; robot < instance->robots; robot++) {
        double J[UNKNOWNS][KNOWNS];
        robot_partials(&instance->robot[robot], J);
        for (size_t i = 0; i < partials->unknown_count; i++) {
            double sum = 0.0;
            for (size_t k = 0; k < partials->known_count; k++) {
                sum += J[unknown_row(partials->unknowns[i])][known_column(partials->knowns[k])] *
                       seed[k * instance->robots + robot];
            }
            sensitivity[i * instance->robots + robot] = sum;
        }
    }
    return STATUS_OK;
}

Status instance_adjoint(Instance *instance, const Partials *partials, const double seed[], double sensitivity[],
                        const char *call) {
    if (check(instance, partials, call) != STATUS_OK) {
        return STATUS_ERROR;
    }
    instance_refresh(instance);
    for (size_t robot = 0; robot < instance->robots; robot++) {
        double J[UNKNOWNS][KNOWNS];
        robot_partials(&instance->robot[robot], J);
        for (size_t k = 0; k < partials->known_count; k++) {
            double sum = 0.0;
            for (size_t i = 0; i < partials->unknown_count; i++) {
                sum += J[unknown_row(partials->unknowns[i])][known_column(partials->knowns[k])] *
                       seed[i * instance->robots + robot];
            }
            sensitivity[k * instance->robots + robot] = sum;
        }
    }
    return STATUS_OK;
}
