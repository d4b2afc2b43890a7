/* Co-simulation: steps, the samples inside them, and what is refused. */
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
    return instance_log(instance, STATUS_ERROR, "%s %.17g s is beyond stopTime, %.17g s", what, time,
                        instance->stop_time);
}

static bool sample_is_due(const Instance *instance) {
    for (size_t i = 0; i < instance->robots; i++) {
        if (robot_is_due(&instance->robot[i])) {
            return true;
        }
    }
    return false;
}

static Status check_step(const Instance *instance, double start, double step) {
    if (!isfinite(start) || !isfinite(step)) {
        return instance_log(instance, STATUS_ERROR, "communicationStepSize %g at time %g: both must be finite", step,
                            start);
    }
    if (step <= 0.0) {
        return instance_log(instance, STATUS_ERROR, "communicationStepSize %g at time %g: the step must be above zero",
                            step, start);
    }
    if (start + step <= start) {
        return instance_log(instance, STATUS_ERROR, "communicationStepSize %g at time %.17g does not advance it", step,
                            start);
    }
    if (fabs(start - instance->time) > TIME_TOLERANCE * (fabs(instance->time) + step)) {
        return instance_log(instance, STATUS_ERROR, "currentCommunicationPoint %.17g: the instance is at time %.17g",
                            start, instance->time);
    }
    for (size_t i = 0; i < instance->robots; i++) {
        if (step > LONGEST_STEP * instance->robot[i].sample_time) {
            return instance_log(instance, STATUS_ERROR, "communicationStepSize %g is more than %g sample times", step,
                                LONGEST_STEP);
        }
    }
    if (instance->event_mode && sample_is_due(instance)) {
        return instance_log(instance, STATUS_ERROR, "a sample is due at time %.17g: it is taken in event mode",
                            instance->time);
    }
    return instance_check_stop(instance, start + step, "the end of the step,");
}

static void keep(Instance *instance) {
    memcpy(instance->before, instance->robot, instance->robots * sizeof *instance->robot);
}

static void swap(Instance *instance) {
    Robot *robot = instance->robot;
    instance->robot = instance->before;
    instance->before = robot;
}

static void undo(Instance *instance) {
    swap(instance);
    instance->stale = true;
}

/* Moves all robots over `step`, at most to the first of their samples; returns how far. */
static double move_to_sample(Instance *instance, double step) {
    for (size_t i = 0; i < instance->robots; i++) {
        step = fmin(step, robot_to_sample(&instance->robot[i]));
    }
    for (size_t i = 0; i < instance->robots; i++) {
        robot_move(&instance->robot[i], step);
    }
    instance->stale = true;
    return step;
}

static bool update_asks_to_return(Instance *instance) {
    if (!instance->update) {
        return false;
    }
    instance->mode = MODE_INTERMEDIATE;
    const bool asked = instance->update(instance, instance->time);
    instance->mode = MODE_STEP;
    return asked && instance->early_return;
}

static double shortest_sample_time(const Instance *instance) {
    double shortest = INFINITY;
    for (size_t i = 0; i < instance->robots; i++) {
        shortest = fmin(shortest, instance->robot[i].sample_time);
    }
    return shortest;
}

/* From sample to sample, as long as nobody wants to hear of one. */
static void step_by_samples(Instance *instance, double step, StepEnd *end) {
    const double last = instance->time + step, tolerance = TIME_TOLERANCE * shortest_sample_time(instance);
    bool ended = false;
    while (!ended && !end->event_needed && !end->early_return) {
        step -= move_to_sample(instance, step);
        const bool due = sample_is_due(instance);
        ended = step <= tolerance;
        instance->time = ended ? last : last - step;
        end->event_needed = due && instance->event_mode && (ended || instance->early_return);
        if (due && !end->event_needed) {
            instance_take_samples(instance);
        }
        end->early_return = (end->event_needed || update_asks_to_return(instance)) && !ended;
    }
}

/* What is there now stays, to be taken back to. One robot after the other, while it is at hand: many do not fit into a
 * processor's cache. */
static bool step_each(Instance *instance, double step) {
    bool finite = true;
    for (size_t i = 0; i < instance->robots; i++) {
        Robot *robot = &instance->before[i];
        *robot = instance->robot[i];
        robot_step(robot, step);
        robot_speeds(robot);
        finite = robot_is_finite(robot) && finite;
    }
    swap(instance);
    instance->stale = false;
    return finite;
}

Status instance_step(Instance *instance, double start, double step, StepEnd *end) {
    *end = (StepEnd){false, false};
    if (check_step(instance, start, step) != STATUS_OK) {
        return STATUS_ERROR;
    }
    const double time = instance->time;
    bool finite = false; /* not known yet */
    instance->time = start;
    if (instance->event_mode || instance->update) {
        keep(instance);
        step_by_samples(instance, step, end);
    } else {
        finite = step_each(instance, step);
        instance->time = start + step;
    }
    if (!finite && instance_check_finite(instance) != STATUS_OK) {
        undo(instance);
        instance->time = time;
        *end = (StepEnd){false, false};
        return STATUS_ERROR;
    }
    return STATUS_OK;
}
