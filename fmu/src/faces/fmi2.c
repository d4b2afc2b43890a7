/* The FMI 2.0 face. */
#include "fmi2Functions.h"

#include <math.h>

#define FMI_STATUS fmi2Status
#include "face.h"
#include "variables.h"

/* The logger takes a printf format. Some importers format it and some do not: the message itself suits both. */
static void log_message(const Instance *instance, Status status, const char *category, const char *message) {
    const fmi2CallbackLogger logger = (fmi2CallbackLogger)instance->callback;
    char format[2 * MESSAGE_SIZE];
    char *end = format;
    for (; *message; message++) {
        if (*message == '%') *end++ = '%';
        *end++ = *message;
    }
    *end = '\0';
    logger(instance->environment, instance->name, (fmi2Status)status, category, format);
}

const char *fmi2GetTypesPlatform(void) {
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void) {
    return fmi2Version;
}

fmi2Status fmi2SetDebugLogging(fmi2Component component, fmi2Boolean on, size_t count, const fmi2String categories[]) {
    INSTANCE(component, MODES_ANY);
    return (fmi2Status)instance_set_logging(I, on, count, categories);
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging) {
    UNUSED(resources);
    UNUSED(visible);
    static const char *const TOKENS[] = {TOKEN_2, NULL};
    Instance draft = {.kind = type == fmi2ModelExchange ? KIND_MODEL_EXCHANGE : KIND_CO_SIMULATION,
                      .tokens = TOKENS,
                      .log = log_message};
    if (functions) {
        draft.callback = (void (*)(void))functions->logger;
        draft.environment = functions->componentEnvironment;
    }
    Instance *instance = instance_new(&draft, name, guid, logging);
    if (instance && type != fmi2ModelExchange && type != fmi2CoSimulation) {
        instance_log(instance, STATUS_ERROR, "%s: type %d is neither model exchange nor co-simulation", __func__,
                     (int)type);
        instance_free(instance);
        return NULL;
    }
    return instance;
}

void fmi2FreeInstance(fmi2Component component) {
    instance_free(component);
}

fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean tolerance_defined, fmi2Real tolerance,
                               fmi2Real start, fmi2Boolean stop_defined, fmi2Real stop) {
    UNUSED(tolerance_defined);
    UNUSED(tolerance);
    INSTANCE(component, MODE_INSTANTIATED);
    return (fmi2Status)instance_set_experiment(I, start, stop_defined ? stop : INFINITY);
}

fmi2Status fmi2EnterInitializationMode(fmi2Component component) {
    INSTANCE(component, MODE_INSTANTIATED);
    return (fmi2Status)instance_enter_initialization(I);
}

fmi2Status fmi2ExitInitializationMode(fmi2Component component) {
    INSTANCE(component, MODE_INITIALIZATION);
    instance_refresh(I);
    I->mode = I->kind == KIND_MODEL_EXCHANGE ? MODE_EVENT : MODE_STEP;
    return fmi2OK;
}

fmi2Status fmi2Terminate(fmi2Component component) {
    INSTANCE(component, MODES_RUN);
    I->mode = MODE_TERMINATED;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component component) {
    INSTANCE(component, MODES_ANY);
    return (fmi2Status)instance_reset(I);
}

/* Values ------------------------------------------------------------------------------------------------------- */

fmi2Status fmi2GetReal(fmi2Component component, const fmi2ValueReference vr[], size_t count, fmi2Real value[]) {
    INSTANCE(component, MODES_ANY);
    REQUIRE_VALUES(vr, value);
    return (fmi2Status)instance_get_floats(I, vr, count, value, count, __func__);
}

fmi2Status fmi2SetReal(fmi2Component component, const fmi2ValueReference vr[], size_t count, const fmi2Real value[]) {
    INSTANCE(component, MODES_ANY);
    REQUIRE_VALUES(vr, value);
    return (fmi2Status)instance_set_floats(I, vr, count, value, count, __func__);
}

/* FMI 2 hands out enumerations as integers. */
static const Variable *find_integer(const Instance *I, fmi2ValueReference reference, const char *call) {
    const Type type = instance_has_type(reference, TYPE_INT64) ? TYPE_INT64 : TYPE_INT32;
    return instance_variable(I, type, reference, call);
}

static const Variable *find_boolean(const Instance *I, fmi2ValueReference reference, const char *call) {
    return instance_variable(I, TYPE_BOOLEAN, reference, call);
}

typedef const Variable *Find(const Instance *I, fmi2ValueReference reference, const char *call);

static fmi2Status get_integers(const Instance *I, Find *find, const fmi2ValueReference vr[], size_t count, int value[],
                               const char *call) {
    for (size_t i = 0; i < count; i++) {
        const Variable *variable = find(I, vr[i], call);
        if (!variable) return fmi2Error;
        value[i] = (int)instance_integer(I, variable, 0);
    }
    return fmi2OK;
}

static fmi2Status set_integers(Instance *I, Find *find, const fmi2ValueReference vr[], size_t count, const int value[],
                               const char *call) {
    for (size_t i = 0; i < count; i++) {
        const Variable *variable = find(I, vr[i], call);
        if (!variable) return fmi2Error;
        const Status status = instance_check_integer(I, variable, value[i], call);
        if (status != STATUS_OK) return (fmi2Status)status;
    }
    for (size_t i = 0; i < count; i++) {
        instance_set_integer(I, find(I, vr[i], call), 0, value[i]);
    }
    return fmi2OK;
}

fmi2Status fmi2GetInteger(fmi2Component component, const fmi2ValueReference vr[], size_t count, fmi2Integer value[]) {
    INSTANCE(component, MODES_ANY);
    REQUIRE_VALUES(vr, value);
    return get_integers(I, find_integer, vr, count, value, __func__);
}

fmi2Status fmi2SetInteger(fmi2Component component, const fmi2ValueReference vr[], size_t count,
                          const fmi2Integer value[]) {
    INSTANCE(component, MODES_ANY);
    REQUIRE_VALUES(vr, value);
    return set_integers(I, find_integer, vr, count, value, __func__);
}

fmi2Status fmi2GetBoolean(fmi2Component component, const fmi2ValueReference vr[], size_t count, fmi2Boolean value[]) {
    INSTANCE(component, MODES_ANY);
    REQUIRE_VALUES(vr, value);
    return get_integers(I, find_boolean, vr, count, value, __func__);
}

fmi2Status fmi2SetBoolean(fmi2Component component, const fmi2ValueReference vr[], size_t count,
                          const fmi2Boolean value[]) {
    INSTANCE(component, MODES_ANY);
    REQUIRE_VALUES(vr, value);
    return set_integers(I, find_boolean, vr, count, value, __func__);
}

fmi2Status fmi2GetString(fmi2Component component, const fmi2ValueReference vr[], size_t count, fmi2String value[]) {
    INSTANCE(component, MODES_ANY);
    UNUSED(vr);
    UNUSED(value);
    if (count) REFUSE("the model has no string variables");
    return fmi2OK;
}

fmi2Status fmi2SetString(fmi2Component component, const fmi2ValueReference vr[], size_t count,
                         const fmi2String value[]) {
    INSTANCE(component, MODES_ANY);
    UNUSED(vr);
    UNUSED(value);
    if (count) REFUSE("the model has no string variables");
    return fmi2OK;
}

/* Co-simulation ------------------------------------------------------------------------------------------------ */

fmi2Status fmi2DoStep(fmi2Component component, fmi2Real start, fmi2Real step, fmi2Boolean no_state_before) {
    UNUSED(no_state_before);
    INSTANCE(component, MODE_STEP);
    StepEnd end;
    return (fmi2Status)instance_step(I, start, step, &end);
}

fmi2Status fmi2CancelStep(fmi2Component component) {
    INSTANCE(component, MODES_ANY);
    REFUSE("steps are not asynchronous");
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component component, const fmi2ValueReference vr[], size_t count,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    UNUSED(vr);
    UNUSED(count);
    UNUSED(order);
    UNUSED(value);
    INSTANCE(component, MODES_ANY);
    REFUSE("inputs are not interpolated");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component component, const fmi2ValueReference vr[], size_t count,
                                        const fmi2Integer order[], fmi2Real value[]) {
    UNUSED(vr);
    UNUSED(count);
    UNUSED(order);
    UNUSED(value);
    INSTANCE(component, MODES_ANY);
    REFUSE("outputs have no derivatives to give");
}

fmi2Status fmi2GetStatus(fmi2Component component, const fmi2StatusKind kind, fmi2Status *value) {
    UNUSED(kind);
    UNUSED(value);
    INSTANCE(component, MODES_ANY);
    REFUSE("steps are not asynchronous");
}

fmi2Status fmi2GetRealStatus(fmi2Component component, const fmi2StatusKind kind, fmi2Real *value) {
    INSTANCE(component, MODES_ANY);
    REQUIRE(value);
    if (kind != fmi2LastSuccessfulTime) REFUSE("only the last successful time is known");
    *value = I->time;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component component, const fmi2StatusKind kind, fmi2Integer *value) {
    UNUSED(kind);
    UNUSED(value);
    INSTANCE(component, MODES_ANY);
    REFUSE("there is no status of this type");
}

fmi2Status fmi2GetBooleanStatus(fmi2Component component, const fmi2StatusKind kind, fmi2Boolean *value) {
    INSTANCE(component, MODES_ANY);
    REQUIRE(value);
    if (kind != fmi2Terminated) REFUSE("there is no status of this type");
    *value = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component component, const fmi2StatusKind kind, fmi2String *value) {
    UNUSED(kind);
    UNUSED(value);
    INSTANCE(component, MODES_ANY);
    REFUSE("steps are not asynchronous");
}
