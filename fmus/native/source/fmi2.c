/* FMI 2.0 for co-simulation. */
#include "instance.h"

enum { MODEL_EXCHANGE, CO_SIMULATION };
enum { LAST_SUCCESSFUL_TIME = 2, TERMINATED = 3 }; /* of what fmi2Get...Status is asked for */
typedef void Logger(void *environment, const char *instance, Status, const char *category, const char *, ...);

typedef struct {
    Logger *logger;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, Status);
    void *environment;
} Callbacks;

static void say(const Fmu *f, Status status, const char *category, const char *text)
{
    Logger *logger = (Logger *)f->host.logger;
    char *format = logger ? malloc(2 * strlen(text) + 1) : NULL, *to = format;
    if (!format) return;
    /* a format without arguments: loggers of hosts in other languages do not fill in what it leaves open */
    for (; *text; *to++ = *text++)
        if (*text == '%') *to++ = '%';
    *to = 0;
    logger(f->host.environment, f->name, status, category, format);
    free(format);
}

/* -- life ---------------------------------------------------------------------------------------- */

API const char *fmi2GetTypesPlatform(void)
{
    return "default";
}

API const char *fmi2GetVersion(void)
{
    return "2.0";
}

API Fmu *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
                         const Callbacks *callbacks, int visible, int logging)
{
    (void)resources, (void)visible;
    Host host = {NULL, NULL, logging};
    if (callbacks) {
        host.logger = (void (*)(void))callbacks->logger;
        host.environment = callbacks->environment;
    }
    return create(name, guid, host, type == CO_SIMULATION ? NULL : SAY_NO_MODEL_EXCHANGE);
}

API void fmi2FreeInstance(Fmu *f)
{
    release(f);
}

API Status fmi2SetDebugLogging(Fmu *f, int on, size_t count, const char *const categories[])
{
    (void)on; /* there is nothing but what went wrong */
    return known_categories(f, count, categories);
}

API Status fmi2SetupExperiment(Fmu *f, int tolerance_given, double tolerance, double start_time,
                               int stop_given, double stop_time)
{
    (void)tolerance_given, (void)tolerance;
    return set_up(f, start_time, stop_given ? stop_time : INFINITY);
}

API Status fmi2EnterInitializationMode(Fmu *f)
{
    return enter(f);
}

API Status fmi2ExitInitializationMode(Fmu *f)
{
    return leave(f);
}

API Status fmi2Terminate(Fmu *f)
{
    return finish(f);
}

API Status fmi2Reset(Fmu *f)
{
    return reset(f);
}

API Status fmi2DoStep(Fmu *f, double time, double step, int no_set_state_before)
{
    (void)no_set_state_before;
    Status status = step_by(f, time, step);
    return status == DISCARD ? stop(f, status) : status;
}

API Status fmi2CancelStep(Fmu *f)
{
    return FAIL(f, SAY_NOT_OFFERED);
}

/* -- values -------------------------------------------------------------------------------------- */

API Status fmi2SetReal(Fmu *f, const Reference vr[], size_t count, const double values[])
{
    int needed = REAL | settable(f);
    if (!allowed(vr, count, needed)) return refuse(f, SAY_SET_LATE, vr, count, needed, "real");
    for (size_t i = 0; i < count; i++) f->words[vr[i]] = values[i];
    return changed(f, vr, count);
}

API Status fmi2GetReal(Fmu *f, const Reference vr[], size_t count, double values[])
{
    if (readable(f, vr, count, REAL, "real")) return ERROR;
    for (size_t i = 0; i < count; i++) values[i] = f->words[vr[i]];
    return OK;
}

API Status fmi2SetInteger(Fmu *f, const Reference vr[], size_t count, const int values[])
{
    int needed = INTEGER | settable(f);
    if (!allowed(vr, count, needed)) return refuse(f, SAY_SET_LATE, vr, count, needed, "integer");
    for (size_t i = 0; i < count; i++) {
        int64_t value = values[i];
        memcpy(f->words + vr[i], &value, sizeof value);
    }
    return changed(f, vr, count);
}

API Status fmi2GetInteger(Fmu *f, const Reference vr[], size_t count, int values[])
{
    if (readable(f, vr, count, INTEGER, "integer")) return ERROR;
    for (size_t i = 0; i < count; i++) values[i] = (int)whole(f->words + vr[i]);
    return OK;
}

/* There are no booleans and no strings. */
static Status none(Fmu *f, const char *format, const Reference *vr, size_t count, const char *kind)
{
    return count ? refuse(f, format, vr, count, 0, kind) : OK;
}

API Status fmi2GetBoolean(Fmu *f, const Reference vr[], size_t count, int values[])
{
    (void)values;
    return none(f, SAY_UNREADABLE, vr, count, "boolean");
}

API Status fmi2SetBoolean(Fmu *f, const Reference vr[], size_t count, const int values[])
{
    (void)values;
    return none(f, SAY_SET_LATE, vr, count, "boolean");
}

API Status fmi2GetString(Fmu *f, const Reference vr[], size_t count, const char *values[])
{
    (void)values;
    return none(f, SAY_UNREADABLE, vr, count, "string");
}

API Status fmi2SetString(Fmu *f, const Reference vr[], size_t count, const char *const values[])
{
    (void)values;
    return none(f, SAY_SET_LATE, vr, count, "string");
}

API Status fmi2GetDirectionalDerivative(Fmu *f, const Reference of[], size_t count, const Reference by[],
                                        size_t known, const double seed[], double values[])
{
    (void)of, (void)count, (void)by, (void)known, (void)seed, (void)values;
    return FAIL(f, SAY_NOT_OFFERED);
}

API Status fmi2SetRealInputDerivatives(Fmu *f, const Reference vr[], size_t count, const int order[],
                                       const double values[])
{
    (void)vr, (void)order, (void)values;
    return count ? FAIL(f, SAY_NOT_OFFERED) : OK;
}

API Status fmi2GetRealOutputDerivatives(Fmu *f, const Reference vr[], size_t count, const int order[],
                                        double values[])
{
    (void)vr, (void)order, (void)values;
    return count ? FAIL(f, SAY_NOT_OFFERED) : OK;
}

/* -- state --------------------------------------------------------------------------------------- */

API Status fmi2GetFMUstate(Fmu *f, Saved **state)
{
    return get_state(f, state);
}

API Status fmi2SetFMUstate(Fmu *f, const Saved *state)
{
    return set_state(f, state);
}

API Status fmi2FreeFMUstate(Fmu *f, Saved **state)
{
    return free_state(f, state);
}

API Status fmi2SerializedFMUstateSize(Fmu *f, const Saved *state, size_t *size)
{
    return serialised_size(f, state, size);
}

API Status fmi2SerializeFMUstate(Fmu *f, const Saved *state, char bytes[], size_t size)
{
    return serialise(f, state, bytes, size);
}

API Status fmi2DeSerializeFMUstate(Fmu *f, const char bytes[], size_t size, Saved **state)
{
    return deserialise(f, bytes, size, state);
}

/* -- status -------------------------------------------------------------------------------------- */

API Status fmi2GetRealStatus(Fmu *f, int asked, double *value)
{
    if (asked != LAST_SUCCESSFUL_TIME) return DISCARD;
    *value = f->life.end;
    return OK;
}

API Status fmi2GetBooleanStatus(Fmu *f, int asked, int *value)
{
    if (asked != TERMINATED) return DISCARD;
    *value = f->life.phase == ENDED;
    return OK;
}

API Status fmi2GetStatus(Fmu *f, int asked, Status *value)
{
    (void)f, (void)asked, (void)value;
    return DISCARD;
}

API Status fmi2GetIntegerStatus(Fmu *f, int asked, int *value)
{
    (void)f, (void)asked, (void)value;
    return DISCARD;
}

API Status fmi2GetStringStatus(Fmu *f, int asked, const char **value)
{
    (void)f, (void)asked, (void)value;
    return DISCARD;
}
