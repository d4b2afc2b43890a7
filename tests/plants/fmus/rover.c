/* Somebody else's robot, FMI 2: other names, wheel speeds, a sensor of its own, a file that it needs, and faults on
 * demand. Co-simulation, which moves by Euler steps of its own, and model exchange. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"

enum {
    CMD_LEFT,
    CMD_RIGHT,
    POS_X,
    POS_Y,
    PSI,
    X0,
    Y0,
    PSI0,
    GPS_X,
    GPS_Y,
    COMPASS,
    FAIL_AT,
    NAN_AT,
    DISCARD_AT,
    RADIUS,
    BASE,
    CRASH_AT,
    DICE,
    WALL_AT,
    HANG_AT,
    DER_X,
    DER_Y,
    DER_PSI,
    VARIABLES
};

static const double PART = 0.005; /* s: its own step */

typedef struct {
    double value[VARIABLES], time, gain;
    unsigned noise;
    bool stuck;
    fmi2CallbackFunctions call;
} Rover;

static void begin(Rover *rover) {
    memset(rover->value, 0, sizeof rover->value);
    rover->value[FAIL_AT] = rover->value[NAN_AT] = rover->value[DISCARD_AT] = rover->value[CRASH_AT] = 1e9;
    rover->value[WALL_AT] = rover->value[HANG_AT] = 1e9;
    rover->stuck = false;
    rover->value[RADIUS] = 0.05;
    rover->value[BASE] = 0.6;
    rover->time = 0.0;
    rover->noise = 1;
}

static double read_gain(const char *resources) {
    char path[1024];
    double gain = 0.0;
    snprintf(path, sizeof path, "%s/gain.txt", strncmp(resources, "file://", 7) == 0 ? resources + 7 : resources);
    FILE *file = fopen(path, "r");
    if (file == NULL || fscanf(file, "%lf", &gain) != 1) {
        gain = 0.0;
    }
    if (file != NULL) {
        fclose(file);
    }
    return gain;
}

static void derive(Rover *rover) {
    double *u = rover->value;
    const double v = rover->gain * u[RADIUS] * (u[CMD_RIGHT] + u[CMD_LEFT]) / 2.0;
    u[DER_X] = v * cos(u[PSI]);
    u[DER_Y] = v * sin(u[PSI]);
    u[DER_PSI] = rover->gain * u[RADIUS] * (u[CMD_RIGHT] - u[CMD_LEFT]) / u[BASE];
    if (rover->stuck) {
        u[DER_X] = u[DER_Y] = u[DER_PSI] = 0.0;
    }
}

static double shaken(Rover *rover) {
    rover->noise = rover->noise * 1664525u + 1013904223u;
    return ((double)rover->noise / 4294967296.0 - 0.5) * 0.02;
}

static void measure(Rover *rover) {
    for (int i = 0; i < 3; i++) {
        rover->value[GPS_X + i] = rover->value[POS_X + i] + shaken(rover);
    }
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *call, fmi2Boolean visible, fmi2Boolean logging) {
    (void)name, (void)type, (void)guid, (void)visible, (void)logging;
    Rover *rover = calloc(1, sizeof *rover);
    rover->call = *call;
    rover->gain = read_gain(resources);
    if (rover->gain == 0.0) {
        call->logger(call->componentEnvironment, "rover", fmi2Error, "error", "no %s in my resources", "gain.txt");
        free(rover);
        return NULL;
    }
    begin(rover);
    return rover;
}

void fmi2FreeInstance(fmi2Component c) {
    free(c);
}

fmi2Status fmi2Reset(fmi2Component c) {
    begin(c);
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    Rover *rover = c;
    memcpy(&rover->value[POS_X], &rover->value[X0], 3 * sizeof(double));
    if (rover->value[DICE] != 0.0) {
        FILE *dice = fopen("/dev/urandom", "rb");
        if (dice == NULL || fread(&rover->noise, sizeof rover->noise, 1, dice) != 1) {
            return fmi2Error;
        }
        fclose(dice);
    }
    derive(rover);
    measure(rover);
    return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real value[]) {
    Rover *rover = c;
    for (size_t i = 0; i < n; i++) {
        if (vr[i] >= VARIABLES) {
            return fmi2Error;
        }
        value[i] = rover->time >= rover->value[NAN_AT] ? NAN : rover->value[vr[i]];
    }
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Real value[]) {
    Rover *rover = c;
    for (size_t i = 0; i < n; i++) {
        if (vr[i] == BASE && value[i] <= 0.0) {
            rover->call.logger(rover->call.componentEnvironment, "rover", fmi2Error, "error", "a base of %g m?",
                               value[i]);
            return fmi2Error;
        }
        rover->value[vr[i]] = value[i];
    }
    derive(rover);
    return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean keep) {
    Rover *rover = c;
    (void)keep;
    const double end = time + step;
    if (end > rover->value[CRASH_AT]) {
        abort();
    }
    for (volatile bool hangs = end > rover->value[HANG_AT]; hangs;) {
    }
    if (end > rover->value[DISCARD_AT]) {
        return fmi2Discard;
    }
    if (end > rover->value[FAIL_AT]) {
        rover->call.logger(rover->call.componentEnvironment, "rover", fmi2Error, "error",
                           "the %s motor is on fire at %g s", "left", time);
        return fmi2Error;
    }
    const int parts = (int)lround(step / PART);
    for (int i = 0; i < parts; i++) {
        derive(rover);
        for (int j = 0; j < 3; j++) {
            rover->value[POS_X + j] += step / parts * rover->value[DER_X + j];
        }
    }
    rover->time = end;
    measure(rover);
    return fmi2OK;
}

/* Model exchange */

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) {
    ((Rover *)c)->time = time;
    return fmi2OK;
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n) {
    memcpy(&((Rover *)c)->value[POS_X], x, n * sizeof *x);
    return fmi2OK;
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n) {
    memcpy(x, &((Rover *)c)->value[POS_X], n * sizeof *x);
    return fmi2OK;
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real dx[], size_t n) {
    Rover *rover = c;
    if (rover->time >= rover->value[FAIL_AT]) {
        rover->call.logger(rover->call.componentEnvironment, "rover", fmi2Error, "error", "the left motor is on fire");
        return fmi2Error;
    }
    derive(rover);
    memcpy(dx, &rover->value[DER_X], n * sizeof *dx);
    return fmi2OK;
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x[], size_t n) {
    (void)c;
    for (size_t i = 0; i < n; i++) {
        x[i] = 1.0;
    }
    return fmi2OK;
}

/* A wall, at which it sticks. */
fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real z[], size_t n) {
    for (size_t i = 0; i < n; i++) {
        z[i] = ((Rover *)c)->value[WALL_AT] - ((Rover *)c)->value[POS_X];
    }
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info) {
    Rover *rover = c;
    rover->stuck = rover->stuck || rover->value[POS_X] >= rover->value[WALL_AT] - 1e-9;
    measure(rover);
    memset(info, 0, sizeof *info);
    return fmi2OK;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean keep, fmi2Boolean *event, fmi2Boolean *end) {
    (void)keep;
    measure(c);
    *event = *end = fmi2False;
    return fmi2OK;
}

const char *fmi2GetTypesPlatform(void) {
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void) {
    return fmi2Version;
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerates, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean stops, fmi2Real stop) {
    (void)c, (void)tolerates, (void)tolerance, (void)start, (void)stops, (void)stop;
    return fmi2OK;
}

/* What always goes well. */
#define FINE(name)                                                                                                     \
    fmi2Status name(fmi2Component c) {                                                                                 \
        (void)c;                                                                                                       \
        return fmi2OK;                                                                                                 \
    }
FINE(fmi2EnterInitializationMode)
FINE(fmi2Terminate)
FINE(fmi2EnterEventMode)
FINE(fmi2EnterContinuousTimeMode)
FINE(fmi2CancelStep)
