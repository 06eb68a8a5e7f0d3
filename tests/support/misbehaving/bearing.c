/* A bearing as FMI 2.0 for co-simulation that misbehaves as resources/how.txt says: "CALL DEED".

   CALL: instantiate, setup, enter, leave, set, get, step (the third one), terminate, free. DEED: see `misbehave`.
   Its load is a spring's, of 1 kN/m. It says that no work is done, so no second instance is asked. */

#include <fenv.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define EXPORT __attribute__((visibility("default")))
#define STIFFNESS 1e3

typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*step_finished)(void *, int);
    void *environment;
} Callbacks;

typedef struct {
    const Callbacks *callbacks;
    char name[64], call[16], deed[16];
    double x[2], f[2];
    int steps;
} Bearing;

enum { OK, WARNING, DISCARD, ERROR, FATAL };

static void *log_aside(void *given)
{
    Bearing *b = given;
    b->callbacks->logger(b->callbacks->environment, b->name, WARNING, "solver", "iteration %d", 7);
    return NULL;
}

static int misbehave(Bearing *b, const char *call)
{
    if (strcmp(call, b->call))
        return OK;
    const char *deed = b->deed;
    if (!strcmp(deed, "exit"))
        exit(0);
    if (!strcmp(deed, "_exit"))
        _exit(0);
    if (!strcmp(deed, "abort"))
        abort();
    if (!strcmp(deed, "segv"))
        raise(SIGSEGV);
    if (!strcmp(deed, "divide"))
        raise(SIGFPE);
    if (!strcmp(deed, "kill"))
        kill(getpid(), SIGKILL);
    while (!strcmp(deed, "hang"))
        pause();
    while (!strcmp(deed, "spin"))
        ;
    if (!strcmp(deed, "close")) /* every file of the process */
        for (int file = 3; file < 256; file++)
            close(file);
    if (!strcmp(deed, "error"))
        return ERROR;
    if (!strcmp(deed, "discard") || !strcmp(deed, "end"))
        return DISCARD;
    if (!strcmp(deed, "fatal"))
        return FATAL;
    if (!strcmp(deed, "nan"))
        b->f[1] = NAN;
    if (!strcmp(deed, "chdir") && chdir("/"))
        return ERROR;
    if (!strcmp(deed, "null"))
        b->callbacks->logger(b->callbacks->environment, b->name, WARNING, "category", NULL);
    if (!strcmp(deed, "format")) {
        b->callbacks->logger(b->callbacks->environment, b->name, ERROR, "model", "%s: u = %.2f is outside %d .. %d",
                             "table", 1.25, 0, 1);
        return ERROR;
    }
    if (!strcmp(deed, "long"))
        for (int i = 0; i < 1000; i++)
            b->callbacks->logger(b->callbacks->environment, b->name, WARNING, "model", "%-2000d", i);
    if (!strcmp(deed, "thread")) { /* that logs while the call waits for it */
        pthread_t aside;
        if (pthread_create(&aside, NULL, log_aside, b) || pthread_join(aside, NULL))
            return ERROR;
    }
    if (!strcmp(deed, "odd"))
        return -5;
    if (!strcmp(deed, "round") && fesetround(FE_UPWARD))
        return ERROR;
    if (!strcmp(deed, "orphan") && fork() > 0) /* leaves a child behind that has its files */
        _exit(0);
    while (!strcmp(deed, "orphan"))
        pause();
    if (!strcmp(deed, "noise")) {
        printf("noise\n");
        fflush(stdout);
    }
    return OK;
}

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

EXPORT void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
                             const Callbacks *callbacks, int visible, int logging)
{
    (void)type, (void)guid, (void)visible, (void)logging;
    Bearing *b = callbacks->allocate(1, sizeof *b);
    b->callbacks = callbacks;
    snprintf(b->name, sizeof b->name, "%s", name);
    char path[4096];
    snprintf(path, sizeof path, "%s/how.txt", resources + strlen("file://"));
    FILE *how = fopen(path, "r");
    if (!how || fscanf(how, "%15s %15s", b->call, b->deed) != 2)
        return NULL;
    fclose(how);
    return misbehave(b, "instantiate") > WARNING ? NULL : b;
}

EXPORT void fmi2FreeInstance(Bearing *b)
{
    misbehave(b, "free");
    b->callbacks->release(b);
}

EXPORT int fmi2SetupExperiment(Bearing *b, int given, double tolerance, double start, int limited, double stop)
{
    (void)given, (void)tolerance, (void)start, (void)limited, (void)stop;
    return misbehave(b, "setup");
}

EXPORT int fmi2EnterInitializationMode(Bearing *b) { return misbehave(b, "enter"); }
EXPORT int fmi2ExitInitializationMode(Bearing *b) { return misbehave(b, "leave"); }
EXPORT int fmi2Terminate(Bearing *b) { return misbehave(b, "terminate"); }
EXPORT int fmi2Reset(Bearing *b) { return b ? OK : ERROR; }

EXPORT int fmi2SetReal(Bearing *b, const unsigned *references, size_t count, const double *values)
{
    for (size_t i = 0; i < count; i++)
        b->x[references[i] % 2] = values[i];
    return misbehave(b, "set");
}

EXPORT int fmi2GetReal(Bearing *b, const unsigned *references, size_t count, double *values)
{
    int status = misbehave(b, "get");
    for (size_t i = 0; i < count; i++)
        values[i] = references[i] < 2 ? b->x[references[i]] : references[i] < 4 ? b->f[references[i] % 2] : 0.0;
    return status;
}

/* Whatever is asked for is true, by a number of its own. */
EXPORT int fmi2GetBoolean(Bearing *b, const unsigned *references, size_t count, int *values)
{
    (void)references;
    for (size_t i = 0; i < count; i++)
        values[i] = 2;
    return b ? OK : ERROR;
}

/* fmi2Terminated: whether it ended the simulation itself. */
EXPORT int fmi2GetBooleanStatus(Bearing *b, int kind, int *value)
{
    if (kind != 3)
        return DISCARD;
    *value = !strcmp(b->deed, "end");
    return OK;
}

EXPORT int fmi2DoStep(Bearing *b, double time, double step, int kept)
{
    (void)time, (void)step, (void)kept;
    for (int i = 0; i < 2; i++)
        b->f[i] = -STIFFNESS * b->x[i];
    return ++b->steps == 3 ? misbehave(b, "step") : OK;
}

/* What else a host may look for. */
static int none(void) { return OK; }
#define ALSO(name) EXPORT int name(void) { return none(); }
ALSO(fmi2SetDebugLogging) ALSO(fmi2SetInteger) ALSO(fmi2SetBoolean) ALSO(fmi2SetString)
ALSO(fmi2GetInteger) ALSO(fmi2GetString) ALSO(fmi2GetFMUstate) ALSO(fmi2SetFMUstate)
ALSO(fmi2FreeFMUstate) ALSO(fmi2SerializedFMUstateSize) ALSO(fmi2SerializeFMUstate)
ALSO(fmi2DeSerializeFMUstate) ALSO(fmi2GetDirectionalDerivative) ALSO(fmi2SetRealInputDerivatives)
ALSO(fmi2GetRealOutputDerivatives) ALSO(fmi2CancelStep) ALSO(fmi2GetStatus) ALSO(fmi2GetRealStatus)
ALSO(fmi2GetIntegerStatus) ALSO(fmi2GetStringStatus)
