/* The FMI 2.0 face: saved states and partial derivatives. */
#include "fmi2Functions.h"

#define FMI_STATUS fmi2Status
#include "face.h"

fmi2Status fmi2GetFMUstate(fmi2Component component, fmi2FMUstate *state) {
    UNUSED(state);
    INSTANCE(component, MODES_ANY);
    REFUSE("not offered");
}

fmi2Status fmi2SetFMUstate(fmi2Component component, fmi2FMUstate state) {
    UNUSED(state);
    INSTANCE(component, MODES_ANY);
    REFUSE("not offered");
}

fmi2Status fmi2FreeFMUstate(fmi2Component component, fmi2FMUstate *state) {
    UNUSED(state);
    INSTANCE(component, MODES_ANY);
    REFUSE("not offered");
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component component, fmi2FMUstate state, size_t *size) {
    UNUSED(state);
    UNUSED(size);
    INSTANCE(component, MODES_ANY);
    REFUSE("not offered");
}

fmi2Status fmi2SerializeFMUstate(fmi2Component component, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
    UNUSED(state);
    UNUSED(bytes);
    UNUSED(size);
    INSTANCE(component, MODES_ANY);
    REFUSE("not offered");
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component component, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state) {
    UNUSED(state);
    UNUSED(bytes);
    UNUSED(size);
    INSTANCE(component, MODES_ANY);
    REFUSE("not offered");
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component component, const fmi2ValueReference unknown[], size_t unknowns,
                                        const fmi2ValueReference known[], size_t knowns, const fmi2Real seed[],
                                        fmi2Real sensitivity[]) {
    UNUSED(unknown);
    UNUSED(unknowns);
    UNUSED(known);
    UNUSED(knowns);
    UNUSED(seed);
    UNUSED(sensitivity);
    INSTANCE(component, MODES_ANY);
    REFUSE("not offered");
}
