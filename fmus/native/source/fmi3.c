/* FMI 3.0 for co-simulation. The model's variables are arrays here where they are many of a kind. */
#include "instance.h"

#include <stdbool.h>
typedef void Logger(void *environment, Status, const char *category, const char *message);

static void say(const Fmu *f, Status status, const char *category, const char *text)
{
    Logger *logger = (Logger *)f->host.logger;
    if (logger && (f->host.logging || status >= ERROR)) logger(f->host.environment, status, category, text);
}

/* -- life ---------------------------------------------------------------------------------------- */

API const char *fmi3GetVersion(void)
{
    return "3.0";
}

API Fmu *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible,
                                     bool logging, bool event_mode, bool early_return,
                                     const Reference intermediate[], size_t count, void *environment,
                                     Logger *logger, void (*update)(void))
{
    (void)resources, (void)visible, (void)early_return, (void)intermediate, (void)count, (void)update;
    Host host = {(void (*)(void))logger, environment, logging};
    Fmu *f = create(name, token, host, event_mode ? SAY_NO_EVENT_MODE : NULL);
    if (!f) return NULL;
    f->before = calloc(MODEL.derived, sizeof(double));
    if (f->before) return f;
    release(f);
    return NULL;
}

API Fmu *fmi3InstantiateModelExchange(const char *name, const char *token, const char *resources, bool visible,
                                      bool logging, void *environment, Logger *logger)
{
    (void)resources, (void)visible;
    Host host = {(void (*)(void))logger, environment, logging};
    return create(name, token, host, SAY_NO_MODEL_EXCHANGE);
}

API Fmu *fmi3InstantiateScheduledExecution(const char *name, const char *token, const char *resources, bool visible,
                                           bool logging, void *environment, Logger *logger)
{
    (void)resources, (void)visible;
    Host host = {(void (*)(void))logger, environment, logging};
    return create(name, token, host, SAY_NO_MODEL_EXCHANGE);
}

API void fmi3FreeInstance(Fmu *f)
{
    release(f);
}

API Status fmi3SetDebugLogging(Fmu *f, bool on, size_t count, const char *const categories[])
{
    Status status = known_categories(f, count, categories);
    if (status == OK) f->host.logging = on; /* errors are told in any case: nobody can ask for them later */
    return status;
}

API Status fmi3EnterInitializationMode(Fmu *f, bool tolerance_given, double tolerance, double start_time,
                                       bool stop_given, double stop_time)
{
    (void)tolerance_given, (void)tolerance;
    if (f->life.phase == NEW && set_up(f, start_time, stop_given ? stop_time : INFINITY)) return ERROR;
    return enter(f);
}

API Status fmi3ExitInitializationMode(Fmu *f)
{
    return leave(f);
}

API Status fmi3Terminate(Fmu *f)
{
    return finish(f);
}

API Status fmi3Reset(Fmu *f)
{
    return reset(f);
}

API Status fmi3DoStep(Fmu *f, double time, double step, bool no_set_state_before, bool *event, bool *terminate,
                      bool *early, double *reached)
{
    (void)no_set_state_before;
    memcpy(f->before, f->words, MODEL.derived * sizeof(double));
    Status status = step_by(f, time, step);
    if (status == DISCARD) { /* as if it had not been called: a smaller step may be taken */
        memcpy(f->words, f->before, MODEL.derived * sizeof(double));
        tell(f, status);
    }
    *event = *terminate = *early = false;
    *reached = f->life.end;
    return status;
}

/* -- values -------------------------------------------------------------------------------------- */

/* See that there are as many values as the variables hold, which exist. */
static Status fitting(Fmu *f, const Reference *vr, size_t count, size_t given)
{
    size_t held = 0;
    for (size_t i = 0; i < count; i++) held += MODEL.extents[vr[i]].count;
    return held == given ? OK : FAIL(f, SAY_OTHER_COUNT, (unsigned)given, (unsigned)held);
}

static Status taking(Fmu *f, const Reference *vr, size_t count, size_t given, int type, const char *kind)
{
    int needed = type | settable(f);
    if (!allowed(vr, count, needed)) return refuse(f, SAY_SET_LATE, vr, count, needed, kind);
    return fitting(f, vr, count, given);
}

static Status giving(Fmu *f, const Reference *vr, size_t count, size_t given, int type, const char *kind)
{
    return readable(f, vr, count, type, kind) ? ERROR : fitting(f, vr, count, given);
}

API Status fmi3SetFloat64(Fmu *f, const Reference vr[], size_t count, const double values[], size_t given)
{
    if (taking(f, vr, count, given, REAL, "Float64")) return ERROR;
    for (size_t i = 0; i < count; i++) {
        const Extent e = MODEL.extents[vr[i]];
        for (size_t k = 0; k < e.count; k++) f->words[vr[i] + k * e.stride] = *values++;
    }
    return changed(f, vr, count);
}

API Status fmi3GetFloat64(Fmu *f, const Reference vr[], size_t count, double values[], size_t given)
{
    if (giving(f, vr, count, given, REAL, "Float64")) return ERROR;
    for (size_t i = 0; i < count; i++) {
        const Extent e = MODEL.extents[vr[i]];
        for (size_t k = 0; k < e.count; k++) *values++ = f->words[vr[i] + k * e.stride];
        if (vr[i] == MODEL.time) values[-1] = f->life.phase < STEPPING ? f->life.start : f->life.end;
    }
    return OK;
}

API Status fmi3SetInt64(Fmu *f, const Reference vr[], size_t count, const int64_t values[], size_t given)
{
    if (taking(f, vr, count, given, INTEGER, "Int64")) return ERROR;
    for (size_t i = 0; i < count; i++) {
        const Extent e = MODEL.extents[vr[i]];
        for (size_t k = 0; k < e.count; k++) memcpy(f->words + vr[i] + k * e.stride, values++, sizeof *values);
    }
    return changed(f, vr, count);
}

API Status fmi3GetInt64(Fmu *f, const Reference vr[], size_t count, int64_t values[], size_t given)
{
    if (giving(f, vr, count, given, INTEGER, "Int64")) return ERROR;
    for (size_t i = 0; i < count; i++) {
        const Extent e = MODEL.extents[vr[i]];
        for (size_t k = 0; k < e.count; k++) *values++ = whole(f->words + vr[i] + k * e.stride);
    }
    return OK;
}

/* There are no variables of other types. What follows behind their number differs, and is not looked at: on
   all targets it is the caller's to put it away. */
#define NO_VARIABLES(Type) \
    API Status fmi3Get##Type(Fmu *f, const Reference vr[], size_t count) \
    { \
        return count ? refuse(f, SAY_UNREADABLE, vr, count, 0, #Type) : OK; \
    } \
    API Status fmi3Set##Type(Fmu *f, const Reference vr[], size_t count) \
    { \
        return count ? refuse(f, SAY_SET_LATE, vr, count, 0, #Type) : OK; \
    }
NO_VARIABLES(Float32)
NO_VARIABLES(Int8)
NO_VARIABLES(UInt8)
NO_VARIABLES(Int16)
NO_VARIABLES(UInt16)
NO_VARIABLES(Int32)
NO_VARIABLES(UInt32)
NO_VARIABLES(UInt64)
NO_VARIABLES(Boolean)
NO_VARIABLES(String)
NO_VARIABLES(Binary)
NO_VARIABLES(Clock)

/* -- state --------------------------------------------------------------------------------------- */

API Status fmi3GetFMUState(Fmu *f, Saved **state)
{
    return get_state(f, state);
}

API Status fmi3SetFMUState(Fmu *f, const Saved *state)
{
    return set_state(f, state);
}

API Status fmi3FreeFMUState(Fmu *f, Saved **state)
{
    return free_state(f, state);
}

API Status fmi3SerializedFMUStateSize(Fmu *f, const Saved *state, size_t *size)
{
    return serialised_size(f, state, size);
}

API Status fmi3SerializeFMUState(Fmu *f, const Saved *state, char bytes[], size_t size)
{
    return serialise(f, state, bytes, size);
}

API Status fmi3DeserializeFMUState(Fmu *f, const char bytes[], size_t size, Saved **state)
{
    return deserialise(f, bytes, size, state);
}

/* -- what is not offered: further arguments as above -------------------------------------- */

#define NOT_OFFERED(name) \
    API Status fmi3##name(Fmu *f) \
    { \
        return FAIL(f, SAY_NOT_OFFERED); \
    }
NOT_OFFERED(EnterConfigurationMode)
NOT_OFFERED(ExitConfigurationMode)
NOT_OFFERED(EnterEventMode)
NOT_OFFERED(EnterStepMode)
NOT_OFFERED(EnterContinuousTimeMode)
NOT_OFFERED(GetNumberOfVariableDependencies)
NOT_OFFERED(GetVariableDependencies)
NOT_OFFERED(GetDirectionalDerivative)
NOT_OFFERED(GetAdjointDerivative)
NOT_OFFERED(GetOutputDerivatives)
NOT_OFFERED(GetIntervalDecimal)
NOT_OFFERED(GetIntervalFraction)
NOT_OFFERED(GetShiftDecimal)
NOT_OFFERED(GetShiftFraction)
NOT_OFFERED(SetIntervalDecimal)
NOT_OFFERED(SetIntervalFraction)
NOT_OFFERED(SetShiftDecimal)
NOT_OFFERED(SetShiftFraction)
NOT_OFFERED(EvaluateDiscreteStates)
NOT_OFFERED(UpdateDiscreteStates)
NOT_OFFERED(CompletedIntegratorStep)
NOT_OFFERED(SetTime)
NOT_OFFERED(SetContinuousStates)
NOT_OFFERED(GetContinuousStateDerivatives)
NOT_OFFERED(GetEventIndicators)
NOT_OFFERED(GetContinuousStates)
NOT_OFFERED(GetNominalsOfContinuousStates)
NOT_OFFERED(GetNumberOfEventIndicators)
NOT_OFFERED(GetNumberOfContinuousStates)
NOT_OFFERED(ActivateModelPartition)
