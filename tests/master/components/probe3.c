/* An FMU of FMI 3.0: y = gain u, element by element; n counts steps, big is 2^53 + n, on whether n is odd,
   choice 2 or 3. It returns early at t = 1 s. */
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

typedef struct {
    double u[2], y[2], gain;
    int32_t n;
    uint8_t k;
    bool heard;
    int64_t chosen;
} Probe;

void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible,
                                  bool logging, bool events, bool early, const uint32_t *needed, size_t count,
                                  void *environment, void *log, void *update)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)events, (void)early;
    (void)needed, (void)count, (void)environment, (void)log, (void)update;
    Probe *probe = calloc(1, sizeof *probe);
    if (probe) {
        probe->gain = 2.0;
        probe->u[1] = 3.0;
    }
    return probe;
}

void fmi3FreeInstance(void *instance) { free(instance); }

static void amplify(Probe *probe)
{
    for (int i = 0; i < 2; i++)
        probe->y[i] = probe->gain * probe->u[i];
}

int fmi3EnterInitializationMode(void *instance, bool toleranced, double tolerance, double start, bool ends,
                                double stop)
{
    (void)toleranced, (void)tolerance, (void)start, (void)ends, (void)stop;
    amplify(instance);
    return 0;
}

int fmi3ExitInitializationMode(void *instance)
{
    amplify(instance);
    return 0;
}

int fmi3Terminate(void *instance)
{
    (void)instance;
    return 0;
}

/* Values of u (1), gain (2) and y (3) in the order of the references; 3 where their number is wrong. */
static int exchange(Probe *probe, const uint32_t *references, size_t count, double *values, size_t n, bool set)
{
    size_t at = 0;
    for (size_t i = 0; i < count; i++) {
        double *own = references[i] == 1 ? probe->u : references[i] == 2 ? &probe->gain : probe->y;
        size_t size = references[i] == 2 ? 1 : 2;
        if (at + size > n)
            return 3;
        for (size_t j = 0; j < size; j++, at++)
            *(set ? &own[j] : &values[at]) = *(set ? &values[at] : &own[j]);
    }
    return at == n ? 0 : 3;
}

int fmi3GetFloat64(void *instance, const uint32_t *references, size_t count, double *values, size_t n)
{
    amplify(instance);
    return exchange(instance, references, count, values, n, false);
}

int fmi3SetFloat64(void *instance, const uint32_t *references, size_t count, const double *values, size_t n)
{
    return exchange(instance, references, count, (double *)values, n, true);
}

int fmi3GetInt32(void *instance, const uint32_t *references, size_t count, int32_t *values, size_t n)
{
    for (size_t i = 0; i < count; i++)
        values[i] = references[i] == 4 ? ((Probe *)instance)->n : 300;
    return count == n ? 0 : 3;
}

int fmi3GetInt64(void *instance, const uint32_t *references, size_t count, int64_t *values, size_t n)
{
    const Probe *probe = instance;
    const int64_t most = (int64_t)1 << 53;
    for (size_t i = 0; i < count; i++)
        values[i] = references[i] == 7    ? most + probe->n
                    : references[i] == 10 ? 2 + probe->n % 2
                    : references[i] == 11 ? probe->chosen
                                          : most + 1;
    return count == n ? 0 : 3;
}

int fmi3SetInt64(void *instance, const uint32_t *references, size_t count, const int64_t *values, size_t n)
{
    (void)references;
    ((Probe *)instance)->chosen = values[0];
    return count == 1 && n == 1 && (values[0] == 2 || values[0] == 3) ? 0 : 3;
}

int fmi3GetBoolean(void *instance, const uint32_t *references, size_t count, bool *values, size_t n)
{
    const Probe *probe = instance;
    for (size_t i = 0; i < count; i++)
        values[i] = references[i] == 8 ? probe->n % 2 == 1 : probe->heard;
    return count == n ? 0 : 3;
}

int fmi3SetBoolean(void *instance, const uint32_t *references, size_t count, const bool *values, size_t n)
{
    (void)references;
    ((Probe *)instance)->heard = values[0];
    return count == 1 && n == 1 ? 0 : 3;
}

int fmi3SetUInt8(void *instance, const uint32_t *references, size_t count, const uint8_t *values, size_t n)
{
    (void)references;
    ((Probe *)instance)->k = values[0];
    return count == 1 && n == 1 ? 0 : 3;
}

int fmi3GetUInt8(void *instance, const uint32_t *references, size_t count, uint8_t *values, size_t n)
{
    (void)references;
    values[0] = ((Probe *)instance)->k;
    return count == 1 && n == 1 ? 0 : 3;
}

int fmi3DoStep(void *instance, double time, double step, bool final, bool *event, bool *ends, bool *early,
               double *reached)
{
    (void)final;
    Probe *probe = instance;
    probe->n++;
    *event = *ends = false;
    *early = time + step > 1.0;
    *reached = *early ? 1.0 : time + step;
    return 0;
}

/* What an FMU of its kind has no use for, and the standard asks for all the same. */
#define ABSENT(name) \
    int name(void) { return 3; }
ABSENT(fmi3ActivateModelPartition) ABSENT(fmi3CompletedIntegratorStep) ABSENT(fmi3DeserializeFMUState)
ABSENT(fmi3EnterConfigurationMode) ABSENT(fmi3EnterContinuousTimeMode) ABSENT(fmi3EnterEventMode)
ABSENT(fmi3EnterStepMode) ABSENT(fmi3EvaluateDiscreteStates) ABSENT(fmi3ExitConfigurationMode)
ABSENT(fmi3FreeFMUState) ABSENT(fmi3GetAdjointDerivative) ABSENT(fmi3GetBinary)
ABSENT(fmi3GetClock) ABSENT(fmi3GetContinuousStateDerivatives) ABSENT(fmi3GetContinuousStates)
ABSENT(fmi3GetDirectionalDerivative) ABSENT(fmi3GetEventIndicators) ABSENT(fmi3GetFMUState)
ABSENT(fmi3GetFloat32) ABSENT(fmi3GetInt16) ABSENT(fmi3GetInt8)
ABSENT(fmi3GetIntervalDecimal) ABSENT(fmi3GetIntervalFraction) ABSENT(fmi3GetNominalsOfContinuousStates)
ABSENT(fmi3GetNumberOfContinuousStates) ABSENT(fmi3GetNumberOfEventIndicators)
ABSENT(fmi3GetNumberOfVariableDependencies) ABSENT(fmi3GetOutputDerivatives) ABSENT(fmi3GetShiftDecimal)
ABSENT(fmi3GetShiftFraction) ABSENT(fmi3GetString) ABSENT(fmi3GetUInt16) ABSENT(fmi3GetUInt32)
ABSENT(fmi3GetUInt64) ABSENT(fmi3GetVariableDependencies) ABSENT(fmi3GetVersion)
ABSENT(fmi3InstantiateModelExchange) ABSENT(fmi3InstantiateScheduledExecution) ABSENT(fmi3Reset)
ABSENT(fmi3SerializeFMUState) ABSENT(fmi3SerializedFMUStateSize) ABSENT(fmi3SetBinary)
ABSENT(fmi3SetClock) ABSENT(fmi3SetContinuousStates) ABSENT(fmi3SetDebugLogging)
ABSENT(fmi3SetFMUState) ABSENT(fmi3SetFloat32) ABSENT(fmi3SetInt16) ABSENT(fmi3SetInt32)
ABSENT(fmi3SetInt8) ABSENT(fmi3SetIntervalDecimal) ABSENT(fmi3SetIntervalFraction)
ABSENT(fmi3SetShiftDecimal) ABSENT(fmi3SetShiftFraction) ABSENT(fmi3SetString) ABSENT(fmi3SetTime)
ABSENT(fmi3SetUInt16) ABSENT(fmi3SetUInt32) ABSENT(fmi3SetUInt64) ABSENT(fmi3UpdateDiscreteStates)
