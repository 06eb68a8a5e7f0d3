/* A bare FMI 2.0 host without Python: loads libraries of FMUs and does what stdin says, to each in turn.

   host (LIBRARY GUID RESOURCES)...
   stdin:  set REFERENCE VALUE | start | step TIME STEP | get REFERENCE | renew | memory | leave

   `renew` frees the instances and makes others; `memory` gives what is resident, in kB.
   Values go in and out as hexadecimal floating point, so that nothing is rounded. What the FMUs log goes
   to stderr. Exit status 1: a library cannot be loaded; 2: no instance; 3: a call was not answered OK. */

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef void *Component;
typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*step_finished)(void *, int);
    void *environment;
} Callbacks;

static void log_it(void *environment, const char *name, int status, const char *category, const char *text, ...)
{
    (void)environment, (void)category;
    fprintf(stderr, "%s: status %d: %s\n", name, status, text);
}

typedef struct {
    const char *guid, *resources;
    void *library;
    Component instance;
    Component (*instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int);
    int (*setup)(Component, int, double, double, int, double);
    int (*enter)(Component);
    int (*leave)(Component);
    int (*set)(Component, const unsigned *, size_t, const double *);
    int (*get)(Component, const unsigned *, size_t, double *);
    int (*step)(Component, double, double, int);
    int (*terminate)(Component);
    void (*release)(Component);
} Fmu;

static void *function(const Fmu *f, const char *name)
{
    void *found = dlsym(f->library, name);
    if (!found) {
        fprintf(stderr, "%s\n", dlerror());
        exit(1);
    }
    return found;
}

static void load(Fmu *f, char **names)
{
    f->library = dlopen(names[0], RTLD_NOW | RTLD_LOCAL);
    if (!f->library) {
        fprintf(stderr, "%s\n", dlerror());
        exit(1);
    }
    f->guid = names[1];
    f->resources = names[2];
    f->instantiate = function(f, "fmi2Instantiate");
    f->setup = function(f, "fmi2SetupExperiment");
    f->enter = function(f, "fmi2EnterInitializationMode");
    f->leave = function(f, "fmi2ExitInitializationMode");
    f->set = function(f, "fmi2SetReal");
    f->get = function(f, "fmi2GetReal");
    f->step = function(f, "fmi2DoStep");
    f->terminate = function(f, "fmi2Terminate");
    f->release = function(f, "fmi2FreeInstance");
}

static void make(Fmu *f)
{
    static Callbacks callbacks = {log_it, calloc, free, NULL, NULL};
    f->instance = f->instantiate("hosted", 1, f->guid, f->resources, &callbacks, 0, 1);
    if (!f->instance)
        exit(2);
}

static int start(Fmu *f)
{
    int status = f->setup(f->instance, 0, 0.0, 0.0, 0, 0.0);
    status = status > 1 ? status : f->enter(f->instance);
    return status > 1 ? status : f->leave(f->instance);
}

static double resident(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%*d %ld", &pages) != 1)
        exit(3);
    fclose(file);
    return 1e-3 * (double)pages * (double)sysconf(_SC_PAGESIZE);
}

typedef struct { /* what was read of a command */
    char word[16];
    unsigned reference;
    double value, length;
} Command;

static int read_one(Command *c)
{
    if (scanf("%15s", c->word) != 1)
        return 0;
    if (!strcmp(c->word, "set"))
        return scanf("%u %lf", &c->reference, &c->value) == 2;
    if (!strcmp(c->word, "get"))
        return scanf("%u", &c->reference) == 1;
    if (!strcmp(c->word, "step"))
        return scanf("%lf %lf", &c->value, &c->length) == 2;
    return 1;
}

/* The status of what is done to one FMU. */
static int done(Fmu *f, const Command *c)
{
    double value;
    if (!strcmp(c->word, "set"))
        return f->set(f->instance, &c->reference, 1, &c->value);
    if (!strcmp(c->word, "get")) {
        int status = f->get(f->instance, &c->reference, 1, &value);
        printf("%a\n", value);
        return status;
    }
    if (!strcmp(c->word, "step"))
        return f->step(f->instance, c->value, c->length, 1);
    if (!strcmp(c->word, "start"))
        return start(f);
    if (!strcmp(c->word, "renew")) {
        f->terminate(f->instance);
        f->release(f->instance);
        make(f);
        return 0;
    }
    fprintf(stderr, "what is %s?\n", c->word);
    exit(3);
}

int main(int words, char **arguments)
{
    enum { MOST = 8 };
    Fmu fmus[MOST];
    int count = (words - 1) / 3, status = 0;
    if (words != 3 * count + 1 || !count || count > MOST) {
        fprintf(stderr, "host (LIBRARY GUID RESOURCES)..., at most %d FMUs\n", MOST);
        return 1;
    }
    for (int i = 0; i < count; i++) {
        load(fmus + i, arguments + 1 + 3 * i);
        make(fmus + i);
    }
    Command c;
    while (status <= 1 && read_one(&c)) {
        if (!strcmp(c.word, "leave"))
            return 0; /* without freeing anything */
        if (!strcmp(c.word, "memory"))
            printf("%a\n", resident());
        else
            for (int i = 0; i < count && status <= 1; i++) status = done(fmus + i, &c);
    }
    for (int i = 0; i < count; i++) {
        if (status <= 1)
            fmus[i].terminate(fmus[i].instance);
        fmus[i].release(fmus[i].instance);
    }
    for (int i = 0; i < count; i++) dlclose(fmus[i].library);
    return status <= 1 ? 0 : 3;
}
