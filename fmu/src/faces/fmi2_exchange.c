/* The FMI 2.0 face: model exchange. */
#include "fmi2Functions.h"

#define FMI_STATUS fmi2Status
#include "face.h"

fmi2Status fmi2EnterEventMode(fmi2Component component) {
    INSTANCE(component, MODE_EVENT | MODE_CONTINUOUS_TIME);
    I->mode = MODE_EVENT;
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component component, fmi2EventInfo *info) {
    INSTANCE(component, MODE_EVENT);
    REQUIRE(info);
    instance_take_samples(I);
    info->newDiscreteStatesNeeded = fmi2False;
    info->terminateSimulation = fmi2False;
    info->nominalsOfContinuousStatesChanged = fmi2False;
    info->valuesOfContinuousStatesChanged = fmi2False;
    info->nextEventTimeDefined = fmi2True;
    info->nextEventTime = instance_next_sample(I);
    return fmi2OK;
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component component) {
    INSTANCE(component, MODE_EVENT);
    I->mode = MODE_CONTINUOUS_TIME;
    return fmi2OK;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component component, fmi2Boolean no_state_before,
                                       fmi2Boolean *enter_event_mode, fmi2Boolean *terminate) {
    UNUSED(no_state_before);
    INSTANCE(component, MODE_CONTINUOUS_TIME);
    REQUIRE(enter_event_mode);
    REQUIRE(terminate);
    *enter_event_mode = fmi2False;
    *terminate = fmi2False;
    return (fmi2Status)instance_check_stop(I, I->time, "a completed step's end,");
}

fmi2Status fmi2SetTime(fmi2Component component, fmi2Real time) {
    INSTANCE(component, MODE_EVENT | MODE_CONTINUOUS_TIME);
    return (fmi2Status)instance_set_time(I, time);
}

fmi2Status fmi2SetContinuousStates(fmi2Component component, const fmi2Real states[], size_t count) {
    INSTANCE(component, MODE_EVENT | MODE_CONTINUOUS_TIME);
    REQUIRE(states);
    if (count != STATES * I->robots) REFUSE("the model has 3 continuous states");
    return (fmi2Status)instance_set_states(I, states);
}

fmi2Status fmi2GetContinuousStates(fmi2Component component, fmi2Real states[], size_t count) {
    INSTANCE(component, MODES_EVALUATE);
    REQUIRE(states);
    if (count != STATES * I->robots) REFUSE("the model has 3 continuous states");
    instance_get_states(I, states);
    return fmi2OK;
}

fmi2Status fmi2GetDerivatives(fmi2Component component, fmi2Real derivatives[], size_t count) {
    INSTANCE(component, MODES_EVALUATE);
    REQUIRE(derivatives);
    if (count != STATES * I->robots) REFUSE("the model has 3 continuous states");
    return (fmi2Status)instance_get_derivatives(I, derivatives);
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component component, fmi2Real nominals[], size_t count) {
    INSTANCE(component, MODES_ANY);
    REQUIRE(nominals);
    if (count != STATES * I->robots) REFUSE("the model has 3 continuous states");
    for (size_t i = 0; i < count; i++) nominals[i] = 1.0;
    return fmi2OK;
}

fmi2Status fmi2GetEventIndicators(fmi2Component component, fmi2Real indicators[], size_t count) {
    INSTANCE(component, MODES_EVALUATE);
    UNUSED(indicators);
    if (count) REFUSE("the model has no event indicators");
    return fmi2OK;
}
