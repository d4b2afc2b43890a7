/* Co-simulation: steps, and what is refused of them. A refused step moves no robot. */
#include "instance.h"

#include <math.h>
#include <string.h>

/* Longer than anybody waits for, and short enough to count its samples. */
static const double LONGEST_STEP = 1e9; /* samples */

/* Two times closer than this part of them are the same, computed in two ways. */
static const double TIME_TOLERANCE = 1e-9;

Status instance_check_stop(const Instance *instance, double time, const char *what) {
    const double tolerance = TIME_TOLERANCE * fmax(fabs(time), time - instance->start_time);
    if (time - tolerance <= instance->stop_time) {
        return STATUS_OK;
    }
    return instance_log(instance, STATUS_ERROR, "%s %.17g s is beyond stopTime, %.17g s", what, time, instance->stop_time);
}

static Status check_step(const Instance *instance, double start, double step) {
    if (!isfinite(start) || !isfinite(step)) {
        return instance_log(instance, STATUS_ERROR, "communicationStepSize %g at time %g: both must be finite", step, start);
    }
    if (step <= 0.0) {
        return instance_log(instance, STATUS_ERROR, "communicationStepSize %g at time %g: the step must be above zero", step,
                            start);
    }
    if (start + step <= start) {
        return instance_log(instance, STATUS_ERROR, "communicationStepSize %g at time %.17g does not advance it", step, start);
    }
    if (fabs(start - instance->time) > TIME_TOLERANCE * (fabs(instance->time) + step)) {
        return instance_log(instance, STATUS_ERROR, "currentCommunicationPoint %.17g: the instance is at time %.17g", start,
                            instance->time);
    }
    for (size_t i = 0; i < instance->robots; i++) {
        if (step > LONGEST_STEP * instance->robot[i].sample_time) {
            return instance_log(instance, STATUS_ERROR, "communicationStepSize %g is more than %g sample times", step,
                                LONGEST_STEP);
        }
    }
    return instance_check_stop(instance, start + step, "the end of the step,");
}

static void keep(Instance *instance) {
    memcpy(instance->before, instance->robot, instance->robots * sizeof *instance->robot);
}

static void undo(Instance *instance) {
    Robot *moved = instance->robot;
    instance->robot = instance->before;
    instance->before = moved;
    instance->stale = true;
}

Status instance_step(Instance *instance, double start, double step) {
    if (check_step(instance, start, step) != STATUS_OK) {
        return STATUS_ERROR;
    }
    keep(instance);
    for (size_t i = 0; i < instance->robots; i++) {
        robot_step(&instance->robot[i], step);
    }
    instance->stale = true;
    if (instance_check_finite(instance) != STATUS_OK) {
        undo(instance);
        return STATUS_ERROR;
    }
    instance->time = start + step;
    return STATUS_OK;
}
