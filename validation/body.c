/* A body on a spring as FMI 2.0 for co-simulation, which another body can be coupled to by a second spring.

       m dv/dt = -k (x - rest) - d v - m g + f_in - f,    f = kc (x - x2) + dc (v - v2)

   It gives its motion (x, v) and the force f on the other body. Of the other it takes the motion (x2, v2), or a
   force (f_in): which side of a coupling it is follows from what is connected. clamped: it does not move;
   one_sided: the second spring pushes only; follows: x2 is not taken but integrated from v2, from x2_0 on.
   lost: what its dampers took, where it is not one_sided; elapsed: the time it was stepped through (s).
   Inside it takes steps of Runge and Kutta's fourth order, of 10 us at most. */

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define EXPORT __attribute__((visibility("default")))
#define INNER 1e-5 /* s */

enum { M, K, D, KC, DC, REST, GRAVITY, X0, V0, CLAMPED, ONE_SIDED, FOLLOWS, X2_0, X2, V2, F_IN, X, V, F, LOST, ELAPSED, FOLLOWED, COUNT };
enum { OK, WARNING, DISCARD, ERROR };

typedef struct {
    double r[COUNT];
} Body;

static double push(const double *r, double x, double v, double x2)
{
    double f = r[KC] * (x - x2) + r[DC] * (v - r[V2]);
    return r[ONE_SIDED] != 0.0 && (x <= x2 || f < 0.0) ? 0.0 : f;
}

static double other(const double *r)
{
    return r[FOLLOWS] != 0.0 ? r[FOLLOWED] : r[X2];
}

static double pull(const double *r, double x, double v, double x2)
{
    double f = -r[K] * (x - r[REST]) - r[D] * v + r[F_IN] - push(r, x, v, x2);
    return r[CLAMPED] != 0.0 ? 0.0 : f / r[M] - r[GRAVITY];
}

static double damping(const double *r, double v)
{
    return r[D] * v * v + r[DC] * (v - r[V2]) * (v - r[V2]);
}

static void refresh(double *r)
{
    r[F] = push(r, r[X], r[V], other(r));
}

static void advance(double *r, double h)
{
    double x = r[X], v = r[V], y = other(r), w = r[FOLLOWS] != 0.0 ? r[V2] : 0.0;
    double a1 = pull(r, x, v, y);
    double v2 = v + 0.5 * h * a1, a2 = pull(r, x + 0.5 * h * v, v2, y + 0.5 * h * w);
    double v3 = v + 0.5 * h * a2, a3 = pull(r, x + 0.5 * h * v2, v3, y + 0.5 * h * w);
    double v4 = v + h * a3, a4 = pull(r, x + h * v3, v4, y + h * w);
    r[LOST] += h / 6.0 * (damping(r, v) + 2.0 * damping(r, v2) + 2.0 * damping(r, v3) + damping(r, v4));
    r[X] = x + h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
    r[V] = v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    r[FOLLOWED] += h * w;
}

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

EXPORT void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
                             const void *callbacks, int visible, int logging)
{
    (void)name, (void)type, (void)guid, (void)resources, (void)callbacks, (void)visible, (void)logging;
    Body *b = calloc(1, sizeof *b);
    if (b)
        b->r[M] = 1.0;
    return b;
}

EXPORT void fmi2FreeInstance(void *c) { free(c); }
EXPORT int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const *s)
{
    (void)c, (void)on, (void)n, (void)s;
    return OK;
}
EXPORT int fmi2SetupExperiment(void *c, int t, double tolerance, double start, int s, double stop)
{
    (void)c, (void)t, (void)tolerance, (void)start, (void)s, (void)stop;
    return OK;
}

static int begin(double *r)
{
    r[X] = r[X0], r[V] = r[V0], r[FOLLOWED] = r[X2_0];
    refresh(r);
    return OK;
}

EXPORT int fmi2EnterInitializationMode(void *c) { return begin(((Body *)c)->r); }
EXPORT int fmi2ExitInitializationMode(void *c) { return begin(((Body *)c)->r); }
EXPORT int fmi2Terminate(void *c) { (void)c; return OK; }
EXPORT int fmi2Reset(void *c) { (void)c; return ERROR; }

EXPORT int fmi2SetReal(void *c, const unsigned *vr, size_t n, const double *value)
{
    for (size_t i = 0; i < n; i++)
        ((Body *)c)->r[vr[i]] = value[i];
    return OK;
}

EXPORT int fmi2GetReal(void *c, const unsigned *vr, size_t n, double *value)
{
    refresh(((Body *)c)->r);
    for (size_t i = 0; i < n; i++)
        value[i] = ((Body *)c)->r[vr[i]];
    return OK;
}

#define UNUSED(NAME, TYPE) \
    EXPORT int NAME(void *c, const unsigned *vr, size_t n, TYPE *v) \
    { \
        (void)c, (void)vr, (void)v; \
        return n ? ERROR : OK; \
    }
UNUSED(fmi2GetInteger, int)
UNUSED(fmi2GetBoolean, int)
UNUSED(fmi2GetString, const char *)
UNUSED(fmi2SetInteger, const int)
UNUSED(fmi2SetBoolean, const int)
UNUSED(fmi2SetString, const char *const)

EXPORT int fmi2DoStep(void *c, double time, double step, int keep)
{
    (void)time, (void)keep;
    double *r = ((Body *)c)->r;
    long parts = (long)ceil(step / INNER - 1e-9);
    for (long k = 0; k < parts; k++)
        advance(r, step / (double)parts);
    r[ELAPSED] += step;
    return OK;
}

EXPORT int fmi2GetFMUstate(void *c, void **state)
{
    if (!*state && !(*state = malloc(sizeof(Body))))
        return ERROR;
    memcpy(*state, c, sizeof(Body));
    return OK;
}
EXPORT int fmi2SetFMUstate(void *c, void *state)
{
    memcpy(c, state, sizeof(Body));
    return OK;
}
EXPORT int fmi2FreeFMUstate(void *c, void **state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return OK;
}

#define ALSO(NAME) \
    EXPORT int NAME(void) { return ERROR; }
ALSO(fmi2SerializedFMUstateSize) ALSO(fmi2SerializeFMUstate) ALSO(fmi2DeSerializeFMUstate)
ALSO(fmi2GetDirectionalDerivative) ALSO(fmi2SetRealInputDerivatives) ALSO(fmi2GetRealOutputDerivatives)
ALSO(fmi2CancelStep) ALSO(fmi2GetStatus) ALSO(fmi2GetRealStatus) ALSO(fmi2GetIntegerStatus)
ALSO(fmi2GetBooleanStatus) ALSO(fmi2GetStringStatus)
