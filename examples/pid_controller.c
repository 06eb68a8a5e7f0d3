/* pid_controller.py once more, as a C FMU: the functions of FMI 2.0 for co-simulation,
   and nothing else. Two axes, stepped once per sample, SI.

   The archive is pid_controller.xml, named modelDescription.xml, and binaries/linux64/pid_controller_c.so:
       cc -O2 -shared -fPIC -o binaries/linux64/pid_controller_c.so pid_controller.c -lm */
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef void *Component;
typedef const char *String;
typedef unsigned int Reference;
enum { OK = 0, ERROR = 3 };

/* Value references: places in `Controller.values`. */
enum { POS_A, POS_B, HOLD_A, HOLD_B, CUR_A, CUR_B, K_P, K_I, K_D, CUT_OFF, MOST, COUNT };

typedef struct {
    double integral, derivative, before; /* A, A, m */
} Axis;

typedef struct {
    double values[COUNT];
    Axis axes[2];
    int begun;
} Controller;

static const double STARTS[COUNT] = {0, 0, 0, 0, 0, 0, 9.7e3, 4e4, 15.5, 6000.0, 4.0};

/* The current (A) that answers to an error (m): PID with a filtered derivative; the integral stays where
   the output is at its limit and would be led further out. */
static double answer(Axis *axis, const double *v, double error, double period)
{
    double slope = v[K_D] * v[CUT_OFF] * (error - axis->before);
    axis->derivative = (axis->derivative + slope) / (1.0 + v[CUT_OFF] * period);
    axis->before = error;
    double step = v[K_I] * period * error;
    double current = v[K_P] * error + axis->integral + axis->derivative;
    if (fabs(current + step) <= v[MOST] || (current + step) * step < 0.0) {
        axis->integral += step;
        current += step;
    }
    return fmin(fmax(current, -v[MOST]), v[MOST]);
}

int fmi2DoStep(Component component, double time, double step, int no_way_back)
{
    (void)time, (void)no_way_back;
    Controller *c = component;
    double *v = c->values;
    if (!c->begun) { /* with the current that carries the weight */
        c->axes[0].integral = v[HOLD_A];
        c->axes[1].integral = v[HOLD_B];
        c->begun = 1;
    }
    v[CUR_A] = answer(&c->axes[0], v, -v[POS_A], step);
    v[CUR_B] = answer(&c->axes[1], v, -v[POS_B], step);
    return OK;
}

int fmi2Reset(Component component)
{
    Controller *c = component;
    memset(c, 0, sizeof *c);
    memcpy(c->values, STARTS, sizeof STARTS);
    return OK;
}

Component fmi2Instantiate(String name, int kind, String guid, String resources, const void *callbacks,
                          int visible, int logging)
{
    (void)name, (void)kind, (void)guid, (void)resources, (void)callbacks, (void)visible, (void)logging;
    Controller *c = malloc(sizeof *c);
    if (c) fmi2Reset(c);
    return c;
}

void fmi2FreeInstance(Component component)
{
    free(component);
}

int fmi2GetReal(Component component, const Reference *which, size_t count, double *values)
{
    Controller *c = component;
    for (size_t k = 0; k < count; k++) {
        if (which[k] >= COUNT) return ERROR;
        values[k] = c->values[which[k]];
    }
    return OK;
}

int fmi2SetReal(Component component, const Reference *which, size_t count, const double *values)
{
    Controller *c = component;
    for (size_t k = 0; k < count; k++) {
        if (which[k] >= COUNT) return ERROR;
        c->values[which[k]] = values[k];
    }
    return OK;
}

/* What there is nothing to do for. */
String fmi2GetVersion(void) { return "2.0"; }
String fmi2GetTypesPlatform(void) { return "default"; }
int fmi2SetupExperiment(Component c, int d, double tolerance, double start, int ends, double stop)
{
    (void)c, (void)d, (void)tolerance, (void)start, (void)ends, (void)stop;
    return OK;
}
int fmi2EnterInitializationMode(Component c) { (void)c; return OK; }
int fmi2ExitInitializationMode(Component c) { (void)c; return OK; }
int fmi2Terminate(Component c) { (void)c; return OK; }
int fmi2SetDebugLogging(Component c, int on, size_t count, const String *categories)
{
    (void)c, (void)on, (void)count, (void)categories;
    return OK;
}

/* What the standard demands to be there, and what nobody calls: the description states no such variable or
   capability. */
#define REFUSED(name) \
    int fmi2##name(void) { return ERROR; }
REFUSED(GetInteger)
REFUSED(GetBoolean)
REFUSED(GetString)
REFUSED(SetInteger)
REFUSED(SetBoolean)
REFUSED(SetString)
REFUSED(GetFMUstate)
REFUSED(SetFMUstate)
REFUSED(FreeFMUstate)
REFUSED(SerializedFMUstateSize)
REFUSED(SerializeFMUstate)
REFUSED(DeSerializeFMUstate)
REFUSED(GetDirectionalDerivative)
REFUSED(SetRealInputDerivatives)
REFUSED(GetRealOutputDerivatives)
REFUSED(CancelStep)
REFUSED(GetStatus)
REFUSED(GetRealStatus)
REFUSED(GetIntegerStatus)
REFUSED(GetBooleanStatus)
REFUSED(GetStringStatus)
