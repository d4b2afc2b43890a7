/* A small importer: loads the FMU's library, drives the robot by FMI 2.0 and by FMI 3.0, prints its pose in hexadecimal.
 *
 * It does not link the mathematics library, so the FMU has to bring its own need of it. Usage: host LIBRARY TICKS
 */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2FunctionTypes.h"
#include "fmi3FunctionTypes.h"
#include "variables.h"

static const uint32_t WHEELS[2] = {VR_OMEGA_LEFT, VR_OMEGA_RIGHT};
static const uint32_t POSE[3] = {VR_X, VR_Y, VR_THETA};
static const double SPEEDS[2] = {4.0, 9.0};

#define LOAD(NAME)                                                                                                     \
    NAME##TYPE *NAME = NULL;                                                                                           \
    void *found_##NAME = dlsym(library, #NAME);                                                                        \
    if (!found_##NAME) return 1;                                                                                       \
    memcpy(&NAME, &found_##NAME, sizeof found_##NAME)

#define DO(CALL)                                                                                                       \
    if (CALL) {                                                                                                        \
        fprintf(stderr, "%s failed\n", #CALL);                                                                         \
        return 1;                                                                                                      \
    }

static void print(const double pose[3]) {
    printf("%a %a %a\n", pose[0], pose[1], pose[2]);
}

static int drive2(void *library, int ticks) {
    LOAD(fmi2Instantiate);
    LOAD(fmi2SetupExperiment);
    LOAD(fmi2EnterInitializationMode);
    LOAD(fmi2ExitInitializationMode);
    LOAD(fmi2SetReal);
    LOAD(fmi2DoStep);
    LOAD(fmi2GetReal);
    LOAD(fmi2FreeInstance);
    double pose[3];
    const fmi2CallbackFunctions none = {0};
    fmi2Component robot = fmi2Instantiate("robot", fmi2CoSimulation, TOKEN_2, "", &none, 0, 0);
    DO(!robot)
    DO(fmi2SetupExperiment(robot, 0, 0.0, 0.0, 0, 0.0))
    DO(fmi2EnterInitializationMode(robot))
    DO(fmi2ExitInitializationMode(robot))
    for (int tick = 0; tick < ticks; tick++) {
        DO(fmi2SetReal(robot, WHEELS, 2, SPEEDS))
        DO(fmi2DoStep(robot, tick * 0.01, 0.01, 1))
    }
    DO(fmi2GetReal(robot, POSE, 3, pose))
    fmi2FreeInstance(robot);
    print(pose);
    return 0;
}

static int drive3(void *library, int ticks) {
    LOAD(fmi3InstantiateCoSimulation);
    LOAD(fmi3EnterInitializationMode);
    LOAD(fmi3ExitInitializationMode);
    LOAD(fmi3SetFloat64);
    LOAD(fmi3DoStep);
    LOAD(fmi3GetFloat64);
    LOAD(fmi3FreeInstance);
    double pose[3], last;
    bool event, end, early;
    fmi3Instance robot =
        fmi3InstantiateCoSimulation("robot", TOKEN_3, "", false, false, false, false, NULL, 0, NULL, NULL, NULL);
    DO(!robot)
    DO(fmi3EnterInitializationMode(robot, false, 0.0, 0.0, false, 0.0))
    DO(fmi3ExitInitializationMode(robot))
    for (int tick = 0; tick < ticks; tick++) {
        DO(fmi3SetFloat64(robot, WHEELS, 2, SPEEDS, 2))
        DO(fmi3DoStep(robot, tick * 0.01, 0.01, true, &event, &end, &early, &last))
    }
    DO(fmi3GetFloat64(robot, POSE, 3, pose, 3))
    fmi3FreeInstance(robot);
    print(pose);
    return 0;
}

int main(int count, char **arguments) {
    if (count != 3) return 2;
    void *library = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return 1;
    }
    const int ticks = atoi(arguments[2]);
    return drive2(library, ticks) || drive3(library, ticks) || dlclose(library);
}
