/* An instance of a model as the faces of FMI see it: fmi2.c, fmi3.c. */
#ifndef FMU_H
#define FMU_H

#include "model.h"
#include "texts.h"

#ifdef _WIN32
#define API __declspec(dllexport)
#else
#define API __attribute__((visibility("default")))
#endif
#define PRINTS __attribute__((format(printf, 2, 3)))

typedef enum { OK, WARNING, DISCARD, ERROR, FATAL } Status; /* as either version counts them */
typedef unsigned int Reference;

typedef struct { /* where an instance is; the times are start and end of the last step, s */
    enum { NEW, INITIALISING, STEPPING, ENDED } phase;
    int failed;
    double start, end;
} Life;

typedef struct { /* whose log it is: a face's own logger, or NULL */
    void (*logger)(void);
    void *environment;
} Host;

typedef struct {
    Life life;
    int stale;    /* outputs do not yet follow from what was set */
    int outdated; /* constants belong to other parameters */
    char *said, *why; /* what was noted last, and what it failed of */
    char *name;
    Host host;
    double *words, *scratch, *settled; /* memory, scratch, the parameters that constants belong to */
} Fmu;

typedef struct {
    size_t size; /* of what follows */
    char bytes[];
} Saved;

/* Of a face: hand a finished text to the host's log. */
void fmu_say(const Fmu *f, Status status, const char *category, const char *text);

/* Note what is wrong (a printf format), for `fail` or for nobody; returns ERROR. */
PRINTS Status fmu_explain(Fmu *f, const char *format, ...);
/* Tell what was noted: a failed instance does not go on. Returns ERROR. */
Status fmu_fail(Fmu *f);
#define FAIL(f, ...) (fmu_explain(f, __VA_ARGS__), fmu_fail(f))

/* A new instance; NULL where there is a `problem` (of the face) or another, which is told. */
Fmu *fmu_create(const char *name, const char *identity, Host host, const char *problem);
void fmu_free(Fmu *f);
Status fmu_set_up(Fmu *f, double start_time);
Status fmu_enter(Fmu *f); /* initialisation */
Status fmu_leave(Fmu *f);
Status fmu_end(Fmu *f);
Status fmu_reset(Fmu *f);
Status fmu_step(Fmu *f, double time, double step);

int64_t fmu_whole(const double *word); /* the whole number that a word holds */
/* Whether each of the variables is of the kind in `needed`, and of one of its causalities. */
int fmu_allowed(const Reference *vr, size_t count, int needed);
/* Fail, naming those that are not; `format` takes their names and a kind in words. */
Status fmu_refuse(Fmu *f, const char *format, const Reference *vr, size_t count, int needed, const char *kind);
/* See that the variables of one type can be read and have values. */
Status fmu_readable(Fmu *f, const Reference *vr, size_t count, int type, const char *kind);
/* Causalities of what may be set now. */
int fmu_settable(const Fmu *f);
/* Note that values were set. */
Status fmu_changed(Fmu *f, const Reference *vr, size_t count);

Status fmu_get_state(Fmu *f, Saved **state);
Status fmu_set_state(Fmu *f, const Saved *state);
Status fmu_free_state(Fmu *f, Saved **state);
Status fmu_serialised_size(Fmu *f, const Saved *state, size_t *size);
Status fmu_serialise(Fmu *f, const Saved *state, char bytes[], size_t size);
Status fmu_deserialise(Fmu *f, const char bytes[], size_t size, Saved **state);

#endif
