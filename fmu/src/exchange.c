/* Model exchange: continuous states; sample events, which co-simulation has too. */
#include "instance.h"

#include <math.h>

static const double SAMPLE_TOLERANCE = 1e-9; /* samples */

void instance_get_states(const Instance *instance, double states[]) {
    for (size_t i = 0; i < instance->robots; i++) {
        states[i] = instance->robot[i].x;
        states[i + instance->robots] = instance->robot[i].y;
        states[i + 2 * instance->robots] = instance->robot[i].theta;
    }
}

Status instance_set_states(Instance *instance, const double states[]) {
    for (size_t i = 0; i < STATES * instance->robots; i++) {
        if (!isfinite(states[i])) {
            return instance_log(instance, STATUS_DISCARD, "continuous state %zu (%s) = %g refused: it must be finite",
                                i, (const char *[]){"x", "y", "theta"}[i / instance->robots], states[i]);
        }
    }
    for (size_t i = 0; i < instance->robots; i++) {
        instance->robot[i].x = states[i];
        instance->robot[i].y = states[i + instance->robots];
        instance->robot[i].theta = states[i + 2 * instance->robots];
    }
    instance->stale = true;
    return STATUS_OK;
}

static Status check_derivatives(const Instance *instance, const double derivatives[]) {
    static const char *const NAME[STATES] = {"der(x)", "der(y)", "der(theta)"};
    for (size_t i = 0; i < STATES * instance->robots; i++) {
        const char *name = NAME[i / instance->robots];
        if (instance_check_value(instance, name, i % instance->robots, derivatives[i]) != STATUS_OK) {
            return STATUS_ERROR;
        }
    }
    return STATUS_OK;
}

Status instance_get_derivatives(Instance *instance, double derivatives[]) {
    instance_refresh(instance);
    for (size_t i = 0; i < instance->robots; i++) {
        Robot *robot = &instance->robot[i];
        robot_derivatives(robot);
        derivatives[i] = robot->der_x;
        derivatives[i + instance->robots] = robot->der_y;
        derivatives[i + 2 * instance->robots] = robot->der_theta;
    }
    return check_derivatives(instance, derivatives);
}

Status instance_set_time(Instance *instance, double time) {
    if (!isfinite(time) || time < instance->start_time) {
        return instance_log(instance, STATUS_ERROR, "time %g s is before the start, %g s, or not finite", time,
                            instance->start_time);
    }
    instance->time = time;
    return STATUS_OK;
}

/* In co-simulation steps find the samples; in model exchange time tells, and may have left some out. */
static bool find_sample(const Instance *instance, Robot *robot) {
    if (instance->kind == KIND_CO_SIMULATION) {
        return robot_is_due(robot);
    }
    const double index = floor((instance->time - instance->start_time) / robot->sample_time + SAMPLE_TOLERANCE);
    if (!(index > (double)robot->sample && index < 9e15)) {
        return false;
    }
    robot->sample = (int64_t)index - 1;
    return true;
}

void instance_take_samples(Instance *instance) {
    for (size_t i = 0; i < instance->robots; i++) {
        if (find_sample(instance, &instance->robot[i])) {
            robot_sample(&instance->robot[i]);
            instance->stale = true;
        }
    }
    instance_log(instance, STATUS_OK, "event at time %g s", instance->time);
}

double instance_next_sample(const Instance *instance) {
    double next = INFINITY;
    for (size_t i = 0; i < instance->robots; i++) {
        const Robot *robot = &instance->robot[i];
        next = fmin(next, instance->start_time + (double)(robot->sample + 1) * robot->sample_time);
    }
    return next;
}
