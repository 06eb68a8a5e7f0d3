/* A bare FMI 2.0 host without Python: loads the library of one FMU and does what stdin says.

   host LIBRARY GUID RESOURCES
   stdin:  set REFERENCE VALUE | start | step TIME STEP | get REFERENCE | renew | memory | leave

   `renew` frees the instance and makes another one; `memory` gives what is resident, in kB.
   Values go in and out as hexadecimal floating point, so that nothing is rounded. What the FMU logs goes
   to stderr. Exit status 1: the library cannot be loaded; 2: no instance; 3: a call was not answered OK. */

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

static void *library;

static void *function(const char *name)
{
    void *found = dlsym(library, name);
    if (!found) {
        fprintf(stderr, "%s\n", dlerror());
        exit(1);
    }
    return found;
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

int main(int count, char **arguments)
{
    if (count != 4) {
        fprintf(stderr, "host LIBRARY GUID RESOURCES\n");
        return 1;
    }
    library = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return 1;
    }
    Component (*instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int) =
        function("fmi2Instantiate");
    int (*setup)(Component, int, double, double, int, double) = function("fmi2SetupExperiment");
    int (*enter)(Component) = function("fmi2EnterInitializationMode");
    int (*leave)(Component) = function("fmi2ExitInitializationMode");
    int (*set)(Component, const unsigned *, size_t, const double *) = function("fmi2SetReal");
    int (*get)(Component, const unsigned *, size_t, double *) = function("fmi2GetReal");
    int (*step)(Component, double, double, int) = function("fmi2DoStep");
    int (*terminate)(Component) = function("fmi2Terminate");
    void (*release)(Component) = function("fmi2FreeInstance");

    Callbacks callbacks = {log_it, calloc, free, NULL, NULL};
    Component fmu = instantiate("hosted", 1, arguments[2], arguments[3], &callbacks, 0, 1);
    if (!fmu)
        return 2;
    char word[16];
    unsigned reference;
    double value, length;
    int status = 0;
    while (status <= 1 && scanf("%15s", word) == 1) {
        if (!strcmp(word, "set") && scanf("%u %lf", &reference, &value) == 2) {
            status = set(fmu, &reference, 1, &value);
        } else if (!strcmp(word, "get") && scanf("%u", &reference) == 1) {
            status = get(fmu, &reference, 1, &value);
            printf("%a\n", value);
        } else if (!strcmp(word, "step") && scanf("%lf %lf", &value, &length) == 2) {
            status = step(fmu, value, length, 1);
        } else if (!strcmp(word, "start")) {
            status = setup(fmu, 0, 0.0, 0.0, 0, 0.0);
            status = status > 1 ? status : enter(fmu);
            status = status > 1 ? status : leave(fmu);
        } else if (!strcmp(word, "renew")) {
            terminate(fmu);
            release(fmu);
            fmu = instantiate("hosted", 1, arguments[2], arguments[3], &callbacks, 0, 1);
            if (!fmu)
                return 2;
        } else if (!strcmp(word, "memory")) {
            printf("%a\n", resident());
        } else if (!strcmp(word, "leave")) {
            return 0; /* without freeing anything */
        } else {
            fprintf(stderr, "what is %s?\n", word);
            return 3;
        }
    }
    if (status <= 1)
        terminate(fmu);
    release(fmu);
    dlclose(library);
    return status <= 1 ? 0 : 3;
}
