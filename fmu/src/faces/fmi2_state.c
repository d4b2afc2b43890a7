/* The FMI 2.0 face: saved states and partial derivatives. */
#include "fmi2Functions.h"

#include <stdlib.h>

#define FMI_STATUS fmi2Status
#include "face.h"

fmi2Status fmi2GetFMUstate(fmi2Component component, fmi2FMUstate *state) {
    INSTANCE(component, MODES_ANY);
    REQUIRE(state);
    return (fmi2Status)instance_save(I, (SavedState **)state);
}

fmi2Status fmi2SetFMUstate(fmi2Component component, fmi2FMUstate state) {
    INSTANCE(component, MODES_ANY);
    REQUIRE(state);
    return (fmi2Status)instance_restore(I, state);
}

fmi2Status fmi2FreeFMUstate(fmi2Component component, fmi2FMUstate *state) {
    INSTANCE(component, MODES_ANY);
    if (state) {
        free(*state);
        *state = NULL;
    }
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component component, fmi2FMUstate state, size_t *size) {
    INSTANCE(component, MODES_ANY);
    REQUIRE(state);
    REQUIRE(size);
    *size = state_size(state);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component component, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
    INSTANCE(component, MODES_ANY);
    REQUIRE(state);
    REQUIRE(bytes);
    return (fmi2Status)state_serialize(I, state, (unsigned char *)bytes, size);
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component component, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state) {
    INSTANCE(component, MODES_ANY);
    REQUIRE(bytes);
    REQUIRE(state);
    return (fmi2Status)state_deserialize(I, (const unsigned char *)bytes, size, (SavedState **)state);
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component component, const fmi2ValueReference unknowns[], size_t n_unknowns,
                                        const fmi2ValueReference knowns[], size_t n_knowns, const fmi2Real seed[],
                                        fmi2Real sensitivity[]) {
    INSTANCE(component, MODES_EVALUATE);
    REQUIRE(unknowns);
    REQUIRE(knowns);
    REQUIRE(seed);
    REQUIRE(sensitivity);
    const Partials partials = {unknowns, knowns, n_unknowns, n_knowns};
    return (fmi2Status)instance_directional(I, &partials, seed, sensitivity, __func__);
}
