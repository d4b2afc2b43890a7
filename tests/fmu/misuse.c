/* Calls both faces at random, in any order and with bad arguments, then asks whether the instance still works.
 *
 * Built together with the FMU's sources under the address and undefined-behaviour sanitizers, which end it at the first
 * fault. Usage: misuse SEED CALLS
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"
#include "fmi3Functions.h"
#include "variables.h"

enum { MOST = 64, BYTES = 4096 };

static uint64_t random_state;

static uint64_t draw(uint64_t below) {
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return random_state % below;
}

static double number(void) {
    static const double SPECIAL[] = {0, 1, -1, 0.01, 1e-9, 0.05, 3, 1e300, -1e300, 1e-320, NAN, INFINITY, -INFINITY};
    return SPECIAL[draw(sizeof SPECIAL / sizeof SPECIAL[0])];
}

static unsigned long lines_logged;

static void note2(void *environment, fmi2String name, fmi2Status status, fmi2String category, fmi2String text, ...) {
    (void)environment;
    lines_logged += name && status > fmi2OK && category && *text && !strchr(text, '\n');
}

static void note3(void *environment, fmi3Status status, fmi3String category, fmi3String text) {
    (void)environment;
    lines_logged += status > fmi3OK && category && *text && !strchr(text, '\n');
}

static fmi3Instance in_step;
static unsigned long updates;

/* Reads what may be read there, tries what may not, and leaves one step in four. */
static void update3(void *environment, double time, bool set, bool get, bool finished, bool can_return, bool *early,
                    double *at) {
    const uint32_t x = VR_X;
    double value;
    size_t size;
    fmi3FMUState none = NULL;
    (void)environment;
    updates += fmi3GetFloat64(in_step, &x, 1, &value, 1) == fmi3OK && get && finished && !set && isfinite(time);
    if (fmi3Reset(in_step) == fmi3OK || fmi3Terminate(in_step) == fmi3OK) abort();
    if (fmi3GetFMUState(in_step, &none) == fmi3OK || fmi3SerializedFMUStateSize(in_step, none, &size) == fmi3OK)
        abort();
    *early = can_return && !draw(4);
    *at = number();
}

static uint32_t references[MOST];
static double floats[MOST], answers[MOST];
static int32_t integers[MOST];
static int64_t longs[MOST];
static uint64_t unsigneds[MOST];
static fmi3Boolean booleans[MOST];
static int booleans2[MOST];
static unsigned char bytes[BYTES];
static size_t bytes_used;

static size_t prepare(void) {
    for (size_t i = 0; i < MOST; i++) {
        references[i] = draw(8) ? (uint32_t)draw(VARIABLES) : (uint32_t)draw(1ull << 32);
        floats[i] = number();
        integers[i] = (int32_t)draw(5) - 1;
        longs[i] = (int64_t)draw(5) - 1;
        unsigneds[i] = draw(9) ? draw(4) : UINT64_MAX - draw(4);
        booleans2[i] = (int)draw(2);
        booleans[i] = !booleans2[i];
    }
    return draw(5);
}

static uint64_t fold(uint64_t sum, const void *data, size_t size) {
    for (size_t i = 0; i < size; i++) sum = (sum ^ ((const unsigned char *)data)[i]) * 0x100000001B3;
    return sum;
}

/* Damages the serialized state, and half of the time makes its checksum fit again. */
static void damage(void) {
    for (uint64_t i = draw(4); bytes_used && i > 0; i--) bytes[draw(bytes_used)] = (unsigned char)draw(256);
    const double value = number();
    if (draw(2) && bytes_used > 64) memcpy(bytes + 8 * draw(bytes_used / 8), &value, sizeof value);
    if (!draw(4)) bytes_used = draw(bytes_used + 9);
    if (draw(2) && bytes_used > 8) {
        const uint64_t sum = fold(fold(0xCBF29CE484222325, TOKEN_3, sizeof TOKEN_3), bytes + 8, bytes_used - 8);
        memcpy(bytes, &sum, sizeof sum);
    }
}

static void call2(fmi2Component c, fmi2FMUstate *state) {
    const size_t n = prepare();
    size_t size = 0;
    fmi2EventInfo info;
    fmi2Boolean enter, end;
    fmi2Real *in = draw(20) ? floats : NULL, *out = draw(20) ? answers : NULL;
    const uint32_t *vr = draw(20) ? references : NULL;
    switch (draw(31)) {
        case 0: fmi2SetupExperiment(c, 0, 0, draw(9) ? 0.0 : number(), !draw(9), number()); break;
        case 1: fmi2EnterInitializationMode(c); break;
        case 2: fmi2ExitInitializationMode(c); break;
        case 3:
            if (!draw(20)) fmi2Terminate(c);
            break;
        case 4:
            if (!draw(20)) fmi2Reset(c);
            break;
        case 5: fmi2GetReal(c, vr, n, out); break;
        case 6: fmi2SetReal(c, vr, n, in); break;
        case 7: fmi2GetInteger(c, vr, n, integers); break;
        case 8: fmi2SetInteger(c, vr, n, integers); break;
        case 9: fmi2GetBoolean(c, vr, n, booleans2); break;
        case 10: fmi2SetBoolean(c, vr, n, booleans2); break;
        case 11:
            if (draw(9)) fmi2GetRealStatus(c, fmi2LastSuccessfulTime, floats);
            fmi2DoStep(c, floats[0], draw(2) ? 0.013 : floats[1] < 1e4 ? floats[1] : -1, 1);
            break;
        case 12: fmi2GetFMUstate(c, draw(20) ? state : NULL); break;
        case 13: fmi2SetFMUstate(c, *state); break;
        case 14: fmi2FreeFMUstate(c, state); break;
        case 15: fmi2SerializedFMUstateSize(c, *state, draw(20) ? &size : NULL); break;
        case 16:
            if (fmi2SerializedFMUstateSize(c, *state, &size) ||
                fmi2SerializeFMUstate(c, *state, (fmi2Byte *)bytes, size - !draw(9)))
                break;
            bytes_used = size;
            break;
        case 17: damage(); break;
        case 18: fmi2DeSerializeFMUstate(c, (const fmi2Byte *)bytes, bytes_used, state); break;
        case 19: fmi2GetDirectionalDerivative(c, vr, n, references + 8, n, in, out); break;
        case 20: fmi2NewDiscreteStates(c, draw(20) ? &info : NULL); break;
        case 21: fmi2EnterEventMode(c); break;
        case 22: fmi2EnterContinuousTimeMode(c); break;
        case 23: fmi2SetTime(c, floats[0]); break;
        case 24: fmi2SetContinuousStates(c, in, 3 - !draw(9)); break;
        case 25: fmi2GetContinuousStates(c, out, 3 - !draw(9)); break;
        case 26: fmi2GetDerivatives(c, out, 3 - !draw(9)); break;
        case 27: fmi2GetNominalsOfContinuousStates(c, out, 3 - !draw(9)); break;
        case 28: fmi2CompletedIntegratorStep(c, 1, &enter, draw(20) ? &end : NULL); break;
        case 29:
            fmi2SetDebugLogging(c, (int)draw(2), draw(2), (const fmi2String[]){draw(2) ? "logEvents" : "nonsense"});
            break;
        default: fmi2GetRealStatus(draw(20) ? c : NULL, (fmi2StatusKind)draw(4), out);
    }
}

static void call3(fmi3Instance c, fmi3FMUState *state) {
    const size_t n = prepare(), m = draw(12);
    size_t size = 0;
    fmi3Boolean b[5];
    fmi3Float64 *in = draw(20) ? floats : NULL, *out = draw(20) ? answers : NULL;
    const uint32_t *vr = draw(20) ? references : NULL;
    switch (draw(35)) {
        case 0: fmi3EnterConfigurationMode(c); break;
        case 1: fmi3ExitConfigurationMode(c); break;
        case 2: fmi3EnterInitializationMode(c, 0, 0, draw(9) ? 0.0 : number(), !draw(9), number()); break;
        case 3: fmi3ExitInitializationMode(c); break;
        case 4:
            if (!draw(20)) fmi3Terminate(c);
            break;
        case 5:
            if (!draw(20)) fmi3Reset(c);
            break;
        case 6: fmi3GetFloat64(c, vr, n, out, m); break;
        case 7: fmi3SetFloat64(c, vr, n, in, m); break;
        case 8: fmi3GetInt32(c, vr, n, integers, m); break;
        case 9: fmi3SetInt32(c, vr, n, integers, m); break;
        case 10: fmi3GetInt64(c, vr, n, longs, m); break;
        case 11: fmi3SetInt64(c, vr, n, longs, m); break;
        case 12: fmi3GetUInt64(c, vr, n, unsigneds, m); break;
        case 13:
            references[0] = VR_ROBOTS;
            fmi3SetUInt64(c, vr, 1, unsigneds, 1);
            break;
        case 14: fmi3GetBoolean(c, vr, n, booleans, m); break;
        case 15: fmi3SetBoolean(c, vr, n, booleans, m); break;
        case 16:
            references[0] = VR_TIME;
            if (draw(9)) fmi3GetFloat64(c, references, 1, floats, 1);
            in_step = c;
            fmi3DoStep(c, floats[0], draw(2) ? 0.013 : floats[1] < 1e4 ? floats[1] : -1, 1, b, b + 1, b + 2, out);
            break;
        case 17: fmi3GetFMUState(c, draw(20) ? state : NULL); break;
        case 18: fmi3SetFMUState(c, *state); break;
        case 19: fmi3FreeFMUState(c, state); break;
        case 20: fmi3SerializedFMUStateSize(c, *state, &size); break;
        case 21:
            if (fmi3SerializedFMUStateSize(c, *state, &size) ||
                fmi3SerializeFMUState(c, *state, bytes, size - !draw(9)))
                break;
            bytes_used = size;
            break;
        case 22: damage(); break;
        case 23: fmi3DeserializeFMUState(c, bytes, bytes_used, state); break;
        case 24: fmi3GetDirectionalDerivative(c, vr, n, references + 8, n, in, m, out, m); break;
        case 25: fmi3GetAdjointDerivative(c, vr, n, references + 8, n, in, m, out, m); break;
        case 26: fmi3UpdateDiscreteStates(c, b, b + 1, b + 2, b + 3, draw(20) ? b + 4 : NULL, out); break;
        case 27: fmi3EnterEventMode(c); break;
        case 28: fmi3EnterContinuousTimeMode(c); break;
        case 29: fmi3SetTime(c, floats[0]); break;
        case 30: fmi3SetContinuousStates(c, in, 3 * draw(4)); break;
        case 31: fmi3GetContinuousStateDerivatives(c, out, 3 * draw(4)); break;
        case 33: fmi3EnterStepMode(c); break;
        case 32: fmi3GetFloat32(c, vr, n, NULL, m); break;
        default: fmi3GetNominalsOfContinuousStates(draw(20) ? c : NULL, out, 3 * draw(4));
    }
}

static int works2(fmi2Component c, int co_simulation) {
    const uint32_t x = VR_X;
    double value;
    return fmi2Reset(c) == fmi2OK && fmi2SetupExperiment(c, 0, 0, 0, 0, 0) == fmi2OK &&
           fmi2EnterInitializationMode(c) == fmi2OK && fmi2ExitInitializationMode(c) == fmi2OK &&
           (!co_simulation || fmi2DoStep(c, 0, 0.01, 1) == fmi2OK) && fmi2GetReal(c, &x, 1, &value) == fmi2OK &&
           isfinite(value);
}

static int works3(fmi3Instance c, int co_simulation, int events) {
    const uint32_t time = VR_TIME;
    double value, last;
    fmi3Boolean b[3];
    return fmi3Reset(c) == fmi3OK && fmi3EnterInitializationMode(c, 0, 0, 0, 0, 0) == fmi3OK &&
           fmi3ExitInitializationMode(c) == fmi3OK && (!events || fmi3EnterStepMode(c) == fmi3OK) &&
           (!co_simulation || fmi3DoStep(c, 0, 0.01, 1, b, b + 1, b + 2, &last) == fmi3OK) &&
           fmi3GetFloat64(c, &time, 1, &value, 1) == fmi3OK && value == (co_simulation ? 0.01 : 0.0);
}

int main(int count, char **arguments) {
    if (count != 3) return 2;
    random_state = strtoull(arguments[1], NULL, 10) * 2654435761u + 1;
    const unsigned long calls = strtoul(arguments[2], NULL, 10);
    const fmi2CallbackFunctions functions = {.logger = note2};
    fmi2Component c2[2] = {fmi2Instantiate("a", fmi2CoSimulation, TOKEN_2, NULL, &functions, 0, 0),
                           fmi2Instantiate("b", fmi2ModelExchange, TOKEN_2, NULL, &functions, 0, 1)};
    fmi3Instance c3[4] = {
        fmi3InstantiateCoSimulation("c", TOKEN_3, NULL, 0, 0, 0, 0, NULL, 0, NULL, note3, NULL),
        fmi3InstantiateModelExchange("d", TOKEN_FLEET, NULL, 0, 1, NULL, note3),
        fmi3InstantiateCoSimulation("h", TOKEN_FLEET, NULL, 0, 0, 0, 1, NULL, 0, NULL, note3, update3),
        fmi3InstantiateCoSimulation("i", TOKEN_3, NULL, 0, 0, 1, 0, NULL, 0, NULL, note3, update3)};
    fmi2FMUstate state2 = NULL;
    fmi3FMUState state3 = NULL;
    if (fmi2Instantiate("e", fmi2CoSimulation, "wrong", NULL, NULL, 0, 0)) return 1;
    if (fmi2Instantiate("f", fmi2CoSimulation, TOKEN_3, NULL, NULL, 0, 0)) return 1;
    if (fmi2Instantiate("g", (fmi2Type)7, TOKEN_2, NULL, NULL, 0, 0)) return 1;
    if (fmi3InstantiateModelExchange(NULL, NULL, NULL, 0, 0, NULL, NULL)) return 1;
    for (unsigned long i = 0; i < calls; i++) {
        call2(c2[draw(2)], &state2);
        call3(c3[draw(4)], &state3);
    }
    int ok = lines_logged > calls / 4;
    for (int i = 0; i < 2; i++) ok = ok && works2(c2[i], !i) && works3(c3[i], !i, 0);
    for (int i = 2; i < 4; i++) {
        in_step = c3[i];
        const unsigned long before = updates;
        ok = ok && works3(c3[i], 1, i == 3) && (i == 3 || updates > before);
    }
    fmi2FreeFMUstate(c2[0], &state2);
    fmi3FreeFMUState(c3[0], &state3);
    for (int i = 0; i < 2; i++) fmi2FreeInstance(c2[i]);
    for (int i = 0; i < 4; i++) fmi3FreeInstance(c3[i]);
    printf("%lu lines logged, %lu intermediate updates\n", lines_logged, updates);
    return ok ? 0 : 1;
}
