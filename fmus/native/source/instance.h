/* An instance of a model, behind whatever version of FMI: its faces fmi2.c and fmi3.c include this file.
   All is static, so that no name in here meets one of a model in C. Words of refusal are those of
   touchdown.fmus.slave. */
#include "model.h"
#include "texts.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef CHECK_X86_64_V3
#include <cpuid.h>
#endif

#ifdef _WIN32
#define API __declspec(dllexport)
#else
#define API __attribute__((visibility("default")))
#endif
#define PRINTS __attribute__((format(printf, 2, 3)))

typedef enum { OK, WARNING, DISCARD, ERROR, FATAL } Status; /* as either version counts them */
typedef unsigned int Reference;

typedef struct { /* where an instance is; the times are start, end of the last step, and end of all, s */
    enum { NEW, INITIALISING, STEPPING, ENDED } phase;
    int failed;
    double start, end, stop; /* stop: what the host announced, or infinity; no number before set-up */
} Life;

typedef struct { /* whose log it is: a face's own logger, or NULL */
    void (*logger)(void);
    void *environment;
    int logging; /* of more than errors */
} Host;

typedef struct {
    Life life;
    int stale;    /* outputs do not yet follow from what was set */
    int outdated; /* constants belong to other parameters */
    char *said, *why; /* what was noted last, and what it failed of */
    char *name;
    Host host;
    double *words, *scratch, *derived_for; /* memory, scratch, the parameters that constants belong to */
    double *before; /* of a face that takes steps back: what it was before the last one */
} Fmu;

typedef struct {
    size_t size; /* of what follows */
    char bytes[];
} Saved;

/* Of a face: hand a finished text to the host's log. */
static void say(const Fmu *f, Status status, const char *category, const char *text);

/* -- failure ------------------------------------------------------------------------------------- */

/* Note what is wrong, for `fail` or for nobody. */
static PRINTS Status explain(Fmu *f, const char *format, ...)
{
    va_list values, again;
    va_start(values, format);
    va_copy(again, values);
    int length = vsnprintf(NULL, 0, format, values);
    char *text = length < 0 ? NULL : malloc((size_t)length + 1);
    if (text) vsnprintf(text, (size_t)length + 1, format, again);
    va_end(values);
    va_end(again);
    free(f->said); /* only now: the text may quote it */
    f->said = text;
    return ERROR;
}

/* Hand what was noted to the host's log. */
static Status tell(Fmu *f, Status status)
{
    const char *text = f->said ? f->said : SAY_NO_MEMORY;
    const char *category = status == DISCARD ? "logStatusDiscard" : "logStatusError";
    say(f, status, category, text);
    return status;
}

/* Tell it, and keep it: a failed instance does not go on. */
static Status stop(Fmu *f, Status status)
{
    tell(f, status);
    free(f->why);
    f->why = f->said;
    f->said = NULL;
    f->life.failed = 1;
    return status;
}

static Status fail(Fmu *f)
{
    return stop(f, ERROR);
}

/* Answer that it failed before. */
static Status stop_again(Fmu *f)
{
    explain(f, SAY_STOPPED, f->why ? f->why : SAY_FAILED_STATE);
    return tell(f, ERROR);
}

#define FAIL(f, ...) (explain(f, __VA_ARGS__), fail(f))

/* A number to be printed; some libraries print the sign of what is no number. */
static double plain(double value)
{
    return isnan(value) ? fabs(value) : value;
}

/* -- constants and start ------------------------------------------------------------------------- */

static void put(double *words, const Word *from, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) memcpy(words + from[i].index, &from[i].bits, sizeof(double));
}

static void clear(double *words, uint32_t from, uint32_t to)
{
    memset(words + from, 0, (to - from) * sizeof(double));
}

static int64_t whole(const double *word)
{
    int64_t value;
    memcpy(&value, word, sizeof value);
    return value;
}

static double number(const double *words, const Slot *s)
{
    return s->access & REAL ? words[s->index] : (double)whole(words + s->index);
}

static Status check_bounds(Fmu *f, int causality)
{
    for (const Slot *s = MODEL.slots; s < MODEL.slots + MODEL.slot_count; s++) {
        if (!(s->access & causality)) continue;
        double v = number(f->words, s);
        if (!isfinite(v)) return explain(f, SAY_NOT_FINITE, s->name, plain(v));
        if (!(v > s->above)) return explain(f, SAY_NOT_ABOVE, s->name, v, s->unit, s->above, s->unit);
        if (v < s->minimum) return explain(f, SAY_TOO_SMALL, s->name, v, s->unit, s->minimum, s->unit);
        if (v > s->maximum) return explain(f, SAY_TOO_LARGE, s->name, v, s->unit, s->maximum, s->unit);
    }
    return OK;
}

static const char *name_of(Reference vr)
{
    if (vr == MODEL.time) return "time";
    for (const Slot *s = MODEL.slots; s < MODEL.slots + MODEL.slot_count; s++)
        if (s->index == vr) return s->name;
    return NULL;
}

/* Name the parameters that there is no table for. */
static Status refuse_choice(Fmu *f)
{
    char chosen[256] = "";
    size_t length = 0;
    for (uint32_t k = 0; k < MODEL.key_count && length < sizeof chosen; k++) {
        Reference key = MODEL.keys[k];
        double value = MODEL.access[key] & REAL ? f->words[key] : (double)whole(f->words + key);
        length += (size_t)snprintf(chosen + length, sizeof chosen - length, "%s%s = %g", k ? ", " : "",
                                   name_of(key), value);
    }
    return explain(f, SAY_NOT_HELD, chosen, MODEL.held);
}

/* Put the constants in that do not come from a kernel but from tables. Where there is none for these
   parameters, which 0 says, the first stands in: `derive` may have more to say about them. */
static int look_up(Fmu *f)
{
    if (!MODEL.table_count) return 1;
    clear(f->words, MODEL.derived, MODEL.message_numbers);
    for (const Table *t = MODEL.tables; t < MODEL.tables + MODEL.table_count; t++) {
        uint32_t k = 0;
        while (k < MODEL.key_count && whole(f->words + MODEL.keys[k]) == t->values[k]) k++;
        if (k < MODEL.key_count) continue;
        put(f->words, t->words, t->count);
        return 1;
    }
    put(f->words, MODEL.tables->words, MODEL.tables->count);
    return 0;
}

/* Compute from the parameters what follows from them. */
static Status derive_constants(Fmu *f)
{
    f->outdated = 1;
    if (check_bounds(f, PARAMETER)) return ERROR;
    int held = look_up(f);
    int64_t problem = derive(f->words);
    if (problem < 0 || problem > MODEL.problem_count) return explain(f, SAY_GAVE_UP, f->life.end);
    if (problem) {
        const Problem *p = &MODEL.problems[problem - 1];
        const double *numbers = f->words + MODEL.message_numbers;
        return explain(f, p->format, numbers[p->numbers[0]], numbers[p->numbers[1]], numbers[p->numbers[2]],
                       numbers[p->numbers[3]]);
    }
    if (!held) return refuse_choice(f);
    memcpy(f->derived_for, f->words + MODEL.parameters, (MODEL.inputs - MODEL.parameters) * sizeof(double));
    f->outdated = 0;
    return OK;
}

/* The same for a started model, whose state has more in use than `derive` knows of: it stays what it is. */
static Status derive_again(Fmu *f)
{
    const size_t size = MODEL.derived * sizeof(double);
    double *kept = malloc(size);
    if (!kept) return explain(f, SAY_NO_MEMORY);
    memcpy(kept, f->words, size);
    Status status = derive_constants(f);
    memcpy(f->words, kept, size);
    free(kept);
    return status;
}

/* State and outputs from parameters and inputs; what is wrong is noted, no more. */
static Status refresh(Fmu *f)
{
    if (derive_constants(f) || check_bounds(f, INPUT)) return ERROR;
    clear(f->words, MODEL.outputs, MODEL.weights);
    put(f->words, MODEL.begun, MODEL.begun_count);
    f->words[MODEL.time] = f->life.start;
    f->words[MODEL.evaluations] = 0.0; /* a whole number, whose zero is the same */
    if (start(f->words)) return explain(f, SAY_GAVE_UP, f->life.start);
    f->stale = 0;
    return OK;
}

/* -- life ---------------------------------------------------------------------------------------- */

static void begin(Fmu *f)
{
    memset(f->words, 0, MODEL.words * sizeof(double));
    put(f->words, MODEL.defaults, MODEL.default_count);
    f->life = (Life){.phase = NEW, .stop = NAN};
    free(f->why);
    f->why = NULL;
    f->stale = f->outdated = 1;
}

static void release(Fmu *f)
{
    if (!f) return;
    free(f->words);
    free(f->scratch);
    free(f->derived_for);
    free(f->before);
    free(f->said);
    free(f->why);
    free(f->name);
    free(f);
}

#ifdef CHECK_X86_64_V3
/* Whether processor and system have AVX2, FMA and BMI2. Asked by hand: not every compiler's own library
   knows __builtin_cpu_supports. */
static int has_x86_64_v3(void)
{
    unsigned a, b, c, d, low, high;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & bit_FMA) || !(c & bit_OSXSAVE)) return 0;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    if ((low & 6) != 6) return 0; /* the system keeps the vector registers */
    return __get_cpuid_count(7, 0, &a, &b, &c, &d) && b & bit_AVX2 && b & bit_BMI2;
}
#endif

/* What keeps this library from being used, or NULL. */
static const char *unusable(const char *identity)
{
    if (!identity || strcmp(identity, MODEL.guid)) return SAY_FOREIGN_GUID;
#ifdef CHECK_X86_64_V3 /* the kernels' code needs it; this file's does not */
    if (!has_x86_64_v3()) return SAY_OLD_PROCESSOR;
#endif
    return NULL;
}

static int is_blank(const char *name)
{
    return !name || !name[strspn(name, " \t\r\n\v\f")];
}

/* Whether the host asks for log categories that there are; what it asks for changes nothing. */
static Status known_categories(Fmu *f, size_t count, const char *const categories[])
{
    static const char *const known[] = {LOG_CATEGORIES};
    for (size_t i = 0; i < count; i++) {
        size_t k = 0;
        while (k < sizeof known / sizeof *known && strcmp(categories[i], known[k])) k++;
        if (k == sizeof known / sizeof *known) {
            explain(f, SAY_NO_CATEGORY, categories[i]);
            return tell(f, ERROR);
        }
    }
    return OK;
}

static Fmu *create(const char *name, const char *identity, Host host, const char *problem)
{
    Fmu *f = calloc(1, sizeof *f);
    if (!f) return NULL;
    f->host = host;
    size_t length = name ? strlen(name) + 1 : 1;
    f->name = calloc(length, 1);
    f->words = calloc(MODEL.words, sizeof(double));
    f->scratch = calloc(MODEL.scratch, sizeof(double));
    f->derived_for = calloc(MODEL.inputs - MODEL.parameters + 1, sizeof(double));
    if (!f->name || !f->words || !f->scratch || !f->derived_for) problem = SAY_NO_MEMORY;
    if (f->name && name) memcpy(f->name, name, length);
    if (!problem && is_blank(name)) problem = SAY_NO_NAME;
    if (!problem) problem = unusable(identity);
    if (problem) {
        explain(f, "%s", problem);
        tell(f, ERROR);
        release(f);
        return NULL;
    }
    begin(f);
    return f;
}

/* stop_time: infinity where the host announces none. */
static Status set_up(Fmu *f, double start_time, double stop_time)
{
    if (f->life.phase != NEW) return FAIL(f, SAY_SETUP_LATE);
    if (!isfinite(start_time)) return FAIL(f, SAY_NO_START, plain(start_time));
    if (!(stop_time > start_time)) return FAIL(f, SAY_NO_STOP, plain(stop_time), start_time);
    f->life.start = start_time;
    f->life.stop = stop_time;
    f->stale = 1;
    return OK;
}

static Status enter(Fmu *f)
{
    if (f->life.phase != NEW) return FAIL(f, SAY_ENTERED_TWICE);
    if (isnan(f->life.stop)) return FAIL(f, SAY_NOT_SET_UP);
    f->life.phase = INITIALISING;
    return OK;
}

static Status leave(Fmu *f)
{
    if (f->life.phase != INITIALISING) return FAIL(f, SAY_NOT_ENTERED);
    if (f->life.failed) return stop_again(f);
    if (refresh(f)) return fail(f);
    f->life.phase = STEPPING;
    f->life.end = f->life.start;
    return OK;
}

static Status finish(Fmu *f)
{
    if (f->life.phase != STEPPING) return FAIL(f, SAY_NOT_TO_END);
    f->life.phase = ENDED;
    return OK;
}

static Status reset(Fmu *f)
{
    begin(f);
    return OK;
}

/* -- steps --------------------------------------------------------------------------------------- */

/* What stopped a macro step, and what to do about it; discarded where a smaller one may be taken. */
static Status explain_step(Fmu *f, int64_t status, double time, double step)
{
    if (status == BAD_INPUT)
        for (const Slot *s = MODEL.slots; s < MODEL.slots + MODEL.slot_count; s++)
            if (s->access & INPUT && !isfinite(f->words[s->index]))
                return explain(f, SAY_BAD_INPUT, s->name, plain(f->words[s->index]), time);
    if (status == BAD_INPUT || status == BAD_LOAD) return explain(f, SAY_BAD_LOAD, time);
    if (status == ROW_OFF) return explain(f, SAY_ROW_OFF, time);
    if (status == TOO_HOT) return explain(f, SAY_TOO_HOT, time);
    if (status == RAISED) return explain(f, SAY_GAVE_UP, time);
    if (status == TOO_MANY_STEPS)
        explain(f, SAY_TOO_MANY_STEPS, MAX_STEPS, step, time);
    else if (status == TOO_LONG_STEP)
        explain(f, SAY_TOO_LONG_STEP, step, time);
    else if (status == TOO_FAST)
        explain(f, SAY_TOO_FAST, time, step, 0.1 * step);
    else
        explain(f, SAY_UNRESOLVED, time, step);
    return DISCARD;
}

/* A macro step. Where it is to be discarded that is noted, not told, and the memory is half a step on. */
static Status step_by(Fmu *f, double time, double step)
{
    Life *life = &f->life;
    if (life->failed) return stop_again(f);
    if (life->phase != STEPPING) return FAIL(f, life->phase == ENDED ? SAY_ENDED : SAY_NOT_STARTED);
    if (fabs(time - life->end) > TIME_TOLERANCE * step) return FAIL(f, SAY_APART, time, step, life->end);
    if (!(step > 0.0) || !isfinite(step) || !isfinite(time)) return FAIL(f, SAY_NO_STEP, plain(time), plain(step));
    if (time + step > life->stop + TIME_TOLERANCE * step) return FAIL(f, SAY_PAST_STOP, time, step, life->stop);
    if (f->outdated && derive_again(f)) return fail(f);
    int64_t status = advance(f->words, f->scratch, time, step);
    if (status) return explain_step(f, status, time, step) == DISCARD ? DISCARD : fail(f);
    life->end = time + step;
    return OK;
}

/* -- values -------------------------------------------------------------------------------------- */

/* Whether each of the variables is of the kind in `needed`, and of one of its causalities. */
static int allowed(const Reference *vr, size_t count, int needed)
{
    for (size_t i = 0; i < count; i++) {
        int access = vr[i] < MODEL.hidden ? MODEL.access[vr[i]] : 0;
        if (!(access & needed & (REAL | INTEGER))) return 0;
        if (!(access & needed & (PARAMETER | INPUT | OUTPUT | TUNABLE | INDEPENDENT))) return 0;
    }
    return 1;
}

static int by_number(const void *one, const void *other)
{
    Reference a = *(const Reference *)one, b = *(const Reference *)other;
    return (a > b) - (a < b);
}

/* The name of a variable as hosts know it: an array's without the index of its first element. */
static void write_name(char *to, size_t room, Reference vr)
{
    const char *name = vr < MODEL.hidden && MODEL.access[vr] ? name_of(vr) : NULL;
    const char *index = name && MODEL.extents && MODEL.extents[vr].stride ? strrchr(name, '[') : NULL;
    if (!name)
        snprintf(to, room, SAY_UNKNOWN, vr);
    else if (!index)
        snprintf(to, room, "%s", name);
    else
        snprintf(to, room, "%.*s%s", (int)(index - name), name, strchr(index, ']') + 1);
}

/* Names of the variables that are not `allowed`, in order, each once; NULL without memory. */
static char *others(const Reference *vr, size_t count, int needed)
{
    size_t length = 1;
    Reference *sorted = malloc(count * sizeof *sorted);
    char *names = calloc(1, 1);
    if (sorted) memcpy(sorted, vr, count * sizeof *sorted), qsort(sorted, count, sizeof *sorted, by_number);
    for (size_t i = 0; sorted && names && i < count; i++) {
        if (allowed(sorted + i, 1, needed) || (i && sorted[i] == sorted[i - 1])) continue;
        char name[256], *longer;
        write_name(name, sizeof name, sorted[i]);
        if ((longer = realloc(names, length + strlen(name) + 2))) {
            names = longer;
            length += (size_t)sprintf(names + length - 1, "%s%s", length > 1 ? ", " : "", name);
        }
    }
    free(sorted);
    return names;
}

static Status refuse(Fmu *f, const char *format, const Reference *vr, size_t count, int needed, const char *kind)
{
    char *names = others(vr, count, needed);
    Status status = FAIL(f, format, names ? names : "", kind);
    free(names);
    return status;
}

/* What may be set now. */
static int settable(const Fmu *f)
{
    return f->life.phase < STEPPING ? PARAMETER | INPUT : TUNABLE | INPUT;
}

/* Note that values were set. */
static Status changed(Fmu *f, const Reference *vr, size_t count)
{
    f->stale = 1;
    if (f->life.phase >= STEPPING)
        for (size_t i = 0; i < count; i++) f->outdated |= !!(MODEL.access[vr[i]] & PARAMETER);
    return OK;
}

/* See that the variables of these kinds can be read and have values: outputs have none before initialisation
   is entered, and until it is complete they are made to follow from what was set. */
static Status readable(Fmu *f, const Reference *vr, size_t count, int type, const char *kind)
{
    const int given = type | PARAMETER | INPUT | INDEPENDENT, all = given | OUTPUT;
    if (!allowed(vr, count, all)) return refuse(f, SAY_UNREADABLE, vr, count, all, kind);
    if (f->life.phase >= STEPPING || allowed(vr, count, given)) return OK;
    if (f->life.phase == NEW) return refuse(f, SAY_READ_EARLY, vr, count, given, kind);
    return f->stale && refresh(f) ? fail(f) : OK;
}

/* -- state --------------------------------------------------------------------------------------- */

/* A saved state: whose it is, where the instance was, and the words up to the constants. */
static size_t state_size(void)
{
    return strlen(MODEL.guid) + sizeof(Life) + MODEL.derived * sizeof(double);
}

static Status free_state(Fmu *f, Saved **state)
{
    (void)f;
    if (state) {
        free(*state);
        *state = NULL;
    }
    return OK;
}

/* Room for a state of `size` bytes in *state, or 0. */
static int room(Saved **state, size_t size)
{
    Saved *fresh = realloc(*state, sizeof *fresh + size);
    if (!fresh) return 0;
    fresh->size = size;
    *state = fresh;
    return 1;
}

static Status get_state(Fmu *f, Saved **state)
{
    const size_t identity = strlen(MODEL.guid);
    if (!room(state, state_size())) return FAIL(f, SAY_NO_MEMORY);
    char *to = (*state)->bytes;
    memcpy(to, MODEL.guid, identity);
    memcpy(to + identity, &f->life, sizeof f->life);
    memcpy(to + identity + sizeof f->life, f->words, MODEL.derived * sizeof(double));
    return OK;
}

static Status set_state(Fmu *f, const Saved *state)
{
    const size_t identity = strlen(MODEL.guid);
    if (!state || state->size != state_size() || memcmp(state->bytes, MODEL.guid, identity))
        return FAIL(f, SAY_FOREIGN_STATE);
    const double announced = f->life.stop; /* by this instance's host; the state may be of a shorter run */
    memcpy(&f->life, state->bytes + identity, sizeof f->life);
    if (isfinite(announced)) f->life.stop = announced;
    memcpy(f->words, state->bytes + identity + sizeof f->life, MODEL.derived * sizeof(double));
    if (!f->life.failed) {
        free(f->why);
        f->why = NULL;
    }
    f->stale = f->life.phase < STEPPING;
    f->outdated |= memcmp(f->derived_for, f->words + MODEL.parameters,
                          (MODEL.inputs - MODEL.parameters) * sizeof(double)) != 0;
    return OK;
}

/* Serialised states end with this number of their bytes (FNV-1a): a state that was changed on its way would
   be taken for places and counts in memory. */
static uint64_t checksum(const char bytes[], size_t size)
{
    uint64_t sum = 0xcbf29ce484222325u;
    for (size_t i = 0; i < size; i++) sum = (sum ^ (unsigned char)bytes[i]) * 0x100000001b3u;
    return sum;
}

static Status serialised_size(Fmu *f, const Saved *state, size_t *size)
{
    if (!state) return FAIL(f, SAY_FOREIGN_STATE);
    *size = state->size + sizeof(uint64_t);
    return OK;
}

static Status serialise(Fmu *f, const Saved *state, char bytes[], size_t size)
{
    if (!state) return FAIL(f, SAY_FOREIGN_STATE);
    if (size < state->size + sizeof(uint64_t)) return FAIL(f, SAY_NO_ROOM);
    const uint64_t sum = checksum(state->bytes, state->size);
    memcpy(bytes, state->bytes, state->size);
    memcpy(bytes + state->size, &sum, sizeof sum);
    return OK;
}

static Status deserialise(Fmu *f, const char bytes[], size_t size, Saved **state)
{
    const size_t own = state_size();
    if (!bytes || size != own + sizeof(uint64_t) || memcmp(bytes, MODEL.guid, strlen(MODEL.guid)))
        return FAIL(f, SAY_FOREIGN_STATE);
    const uint64_t sum = checksum(bytes, own);
    if (memcmp(bytes + own, &sum, sizeof sum)) return FAIL(f, SAY_FOREIGN_STATE);
    *state = NULL; /* the host's variable may hold anything */
    if (!room(state, own)) return FAIL(f, SAY_NO_MEMORY);
    memcpy((*state)->bytes, bytes, own);
    return OK;
}
