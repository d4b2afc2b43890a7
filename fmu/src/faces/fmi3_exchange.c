/* The FMI 3.0 face: events, and model exchange. */
#include "fmi3Functions.h"

#define FMI_STATUS fmi3Status
#include "face.h"

fmi3Status fmi3EnterEventMode(fmi3Instance instance) {
    INSTANCE(instance, MODE_EVENT | MODE_CONTINUOUS_TIME | MODE_STEP | MODE_STEP_EVENT);
    if (I->kind == KIND_CO_SIMULATION && !I->event_mode) REFUSE("the instance was made without event mode");
    I->mode = I->kind == KIND_MODEL_EXCHANGE ? MODE_EVENT : MODE_STEP_EVENT;
    return fmi3OK;
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance) {
    INSTANCE(instance, MODE_INITIALIZATION | MODE_EVENT | MODE_STEP_EVENT);
    return fmi3OK;
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *update_needed, fmi3Boolean *terminate,
                                    fmi3Boolean *nominals_changed, fmi3Boolean *states_changed,
                                    fmi3Boolean *next_time_defined, fmi3Float64 *next_time) {
    INSTANCE(instance, MODE_EVENT | MODE_STEP_EVENT);
    REQUIRE(update_needed);
    REQUIRE(terminate);
    REQUIRE(nominals_changed);
    REQUIRE(states_changed);
    REQUIRE(next_time_defined);
    REQUIRE(next_time);
    instance_take_samples(I);
    *update_needed = fmi3False;
    *terminate = fmi3False;
    *nominals_changed = fmi3False;
    *states_changed = fmi3False;
    *next_time_defined = fmi3True;
    *next_time = instance_next_sample(I);
    return fmi3OK;
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance) {
    INSTANCE(instance, MODE_EVENT);
    I->mode = MODE_CONTINUOUS_TIME;
    return fmi3OK;
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance, fmi3Boolean no_state_before,
                                       fmi3Boolean *enter_event_mode, fmi3Boolean *terminate) {
    UNUSED(no_state_before);
    INSTANCE(instance, MODE_CONTINUOUS_TIME);
    REQUIRE(enter_event_mode);
    REQUIRE(terminate);
    *enter_event_mode = fmi3False;
    *terminate = fmi3False;
    return (fmi3Status)instance_check_stop(I, I->time, "a completed step's end,");
}

fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 time) {
    INSTANCE(instance, MODE_EVENT | MODE_CONTINUOUS_TIME);
    return (fmi3Status)instance_set_time(I, time);
}

fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const fmi3Float64 states[], size_t count) {
    INSTANCE(instance, MODE_EVENT | MODE_CONTINUOUS_TIME);
    REQUIRE(states);
    if (count != STATES * I->robots) REFUSE("a robot has 3 continuous states");
    return (fmi3Status)instance_set_states(I, states);
}

fmi3Status fmi3GetContinuousStates(fmi3Instance instance, fmi3Float64 states[], size_t count) {
    INSTANCE(instance, MODES_EVALUATE);
    REQUIRE(states);
    if (count != STATES * I->robots) REFUSE("a robot has 3 continuous states");
    instance_get_states(I, states);
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance, fmi3Float64 derivatives[], size_t count) {
    INSTANCE(instance, MODES_EVALUATE);
    REQUIRE(derivatives);
    if (count != STATES * I->robots) REFUSE("a robot has 3 continuous states");
    return (fmi3Status)instance_get_derivatives(I, derivatives);
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance, fmi3Float64 nominals[], size_t count) {
    INSTANCE(instance, MODES_EVALUATE);
    REQUIRE(nominals);
    if (count != STATES * I->robots) REFUSE("a robot has 3 continuous states");
    for (size_t i = 0; i < count; i++) nominals[i] = 1.0;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *count) {
    INSTANCE(instance, MODES_ANY);
    REQUIRE(count);
    *count = STATES * I->robots;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *count) {
    INSTANCE(instance, MODES_ANY);
    REQUIRE(count);
    *count = 0;
    return fmi3OK;
}

fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64 indicators[], size_t count) {
    UNUSED(indicators);
    INSTANCE(instance, MODES_EVALUATE);
    if (count) REFUSE("the model has no event indicators");
    return fmi3OK;
}
