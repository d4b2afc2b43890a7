/* The FMI 3.0 face: life cycle and co-simulation. */
#include "fmi3Functions.h"

#include <math.h>

#define FMI_STATUS fmi3Status
#include "face.h"
#include "variables.h"

static void log_message(const Instance *instance, Status status, const char *category, const char *message) {
    const fmi3LogMessageCallback logger = (fmi3LogMessageCallback)instance->callback;
    logger(instance->environment, (fmi3Status)status, category, message);
}

static const char *const TOKENS[] = {TOKEN_3, TOKEN_FLEET, NULL};

/* Nothing is to be set here, everything may be read, and an internal step has just ended. */
static bool intermediate_update(const Instance *instance, double time) {
    const fmi3IntermediateUpdateCallback update = (fmi3IntermediateUpdateCallback)instance->update_callback;
    fmi3Boolean return_early = fmi3False;
    fmi3Float64 return_time = time;
    update(instance->environment, time, fmi3False, fmi3True, fmi3True, instance->early_return, &return_early,
           &return_time);
    return return_early;
}

const char *fmi3GetVersion(void) {
    return fmi3Version;
}

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean on, size_t count, const fmi3String categories[]) {
    INSTANCE(instance, MODES_ANY);
    return (fmi3Status)instance_set_logging(I, on, count, categories);
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                          fmi3Boolean logging, fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback logger) {
    UNUSED(resources);
    UNUSED(visible);
    const Instance draft = {.kind = KIND_MODEL_EXCHANGE,
                            .tokens = TOKENS,
                            .log = log_message,
                            .callback = (void (*)(void))logger,
                            .environment = environment};
    return instance_new(&draft, name, token, logging);
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                         fmi3Boolean logging, fmi3Boolean event_mode, fmi3Boolean early_return,
                                         const fmi3ValueReference intermediate[], size_t intermediates,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                         fmi3IntermediateUpdateCallback update) {
    UNUSED(resources);
    UNUSED(visible);
    UNUSED(intermediate);
    UNUSED(intermediates);
    const Instance draft = {.kind = KIND_CO_SIMULATION,
                            .tokens = TOKENS,
                            .log = log_message,
                            .callback = (void (*)(void))logger,
                            .environment = environment,
                            .update = update ? intermediate_update : NULL,
                            .update_callback = (void (*)(void))update,
                            .event_mode = event_mode,
                            .early_return = early_return};
    return instance_new(&draft, name, token, logging);
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                               fmi3Boolean visible, fmi3Boolean logging,
                                               fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                               fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
                                               fmi3UnlockPreemptionCallback unlock) {
    UNUSED(name);
    UNUSED(token);
    UNUSED(resources);
    UNUSED(visible);
    UNUSED(logging);
    UNUSED(update);
    UNUSED(lock);
    UNUSED(unlock);
    if (logger) logger(environment, fmi3Error, "logStatusError", "scheduled execution is not offered");
    return NULL;
}

void fmi3FreeInstance(fmi3Instance instance) {
    instance_free(instance);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean tolerance_defined, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean stop_defined, fmi3Float64 stop) {
    UNUSED(tolerance_defined);
    UNUSED(tolerance);
    INSTANCE(instance, MODE_INSTANTIATED);
    const Status status = instance_set_experiment(I, start, stop_defined ? stop : INFINITY);
    return (fmi3Status)(status == STATUS_OK ? instance_enter_initialization(I) : status);
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) {
    INSTANCE(instance, MODE_INITIALIZATION);
    instance_refresh(I);
    I->mode = I->kind == KIND_MODEL_EXCHANGE ? MODE_EVENT : I->event_mode ? MODE_STEP_EVENT : MODE_STEP;
    return fmi3OK;
}

fmi3Status fmi3Terminate(fmi3Instance instance) {
    INSTANCE(instance, MODES_RUN);
    I->mode = MODE_TERMINATED;
    return fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance instance) {
    INSTANCE(instance, MODES_ANY);
    return (fmi3Status)instance_reset(I);
}

fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance) {
    INSTANCE(instance, MODE_INSTANTIATED);
    I->mode = MODE_CONFIGURATION;
    return fmi3OK;
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance) {
    INSTANCE(instance, MODE_CONFIGURATION);
    I->mode = MODE_INSTANTIATED;
    return fmi3OK;
}

fmi3Status fmi3EnterStepMode(fmi3Instance instance) {
    INSTANCE(instance, MODE_STEP_EVENT);
    I->mode = MODE_STEP;
    return fmi3OK;
}

fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 start, fmi3Float64 step, fmi3Boolean no_state_before,
                      fmi3Boolean *event_needed, fmi3Boolean *terminate, fmi3Boolean *early_return,
                      fmi3Float64 *last_time) {
    UNUSED(no_state_before);
    INSTANCE(instance, MODE_STEP);
    REQUIRE(event_needed);
    REQUIRE(terminate);
    REQUIRE(early_return);
    REQUIRE(last_time);
    StepEnd end;
    const Status status = instance_step(I, start, step, &end);
    *event_needed = end.event_needed;
    *terminate = fmi3False;
    *early_return = end.early_return;
    *last_time = I->time;
    return (fmi3Status)status;
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                    const fmi3Int32 orders[], fmi3Float64 values[], size_t size) {
    UNUSED(references);
    UNUSED(count);
    UNUSED(orders);
    UNUSED(values);
    UNUSED(size);
    INSTANCE(instance, MODES_ANY);
    REFUSE("outputs have no derivatives to give");
}

fmi3Status fmi3ActivateModelPartition(fmi3Instance instance, fmi3ValueReference clock, fmi3Float64 time) {
    UNUSED(clock);
    UNUSED(time);
    INSTANCE(instance, MODES_ANY);
    REFUSE("scheduled execution is not offered");
}
