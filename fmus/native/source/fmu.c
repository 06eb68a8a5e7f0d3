/* An instance of a model, behind whatever version of FMI. Words of refusal are those of touchdown.fmus.slave. */
#include "fmu.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef CHECK_X86_64_V3
#include <cpuid.h>
#endif

/* -- failure ------------------------------------------------------------------------------------- */

/* Note what is wrong, for `fail` or for nobody. */
Status fmu_explain(Fmu *f, const char *format, ...)
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
    fmu_say(f, status, category, text);
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

Status fmu_fail(Fmu *f)
{
    return stop(f, ERROR);
}

/* Answer that it failed before. */
static Status stop_again(Fmu *f)
{
    fmu_explain(f, SAY_STOPPED, f->why ? f->why : SAY_FAILED_STATE);
    return tell(f, ERROR);
}

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

int64_t fmu_whole(const double *word)
{
    int64_t value;
    memcpy(&value, word, sizeof value);
    return value;
}

static double number(const double *words, const Slot *s)
{
    return s->access & REAL ? words[s->index] : (double)fmu_whole(words + s->index);
}

static Status check_bounds(Fmu *f, int causality)
{
    for (const Slot *s = MODEL.slots; s < MODEL.slots + MODEL.slot_count; s++) {
        if (!(s->access & causality)) continue;
        double v = number(f->words, s);
        if (!isfinite(v)) return fmu_explain(f, SAY_NOT_FINITE, s->name, plain(v));
        if (!(v > s->above)) return fmu_explain(f, SAY_NOT_ABOVE, s->name, v, s->unit, s->above, s->unit);
        if (v < s->minimum) return fmu_explain(f, SAY_TOO_SMALL, s->name, v, s->unit, s->minimum, s->unit);
        if (v > s->maximum) return fmu_explain(f, SAY_TOO_LARGE, s->name, v, s->unit, s->maximum, s->unit);
    }
    return OK;
}

static const char *name_of(Reference vr)
{
    for (const Slot *s = MODEL.slots; s < MODEL.slots + MODEL.slot_count; s++)
        if (s->index == vr) return s->name;
    return NULL;
}

/* Name the parameters that there is no table for. */
static Status refuse_choice(Fmu *f)
{
    char chosen[256] = "";
    size_t length = 0;
    for (uint32_t k = 0; k < MODEL.key_count && length < sizeof chosen; k++)
        length += (size_t)snprintf(chosen + length, sizeof chosen - length, "%s%s = %lld", k ? ", " : "",
                                   name_of(MODEL.keys[k]), (long long)fmu_whole(f->words + MODEL.keys[k]));
    return fmu_explain(f, SAY_NOT_HELD, chosen, MODEL.held);
}

/* Put the constants in that do not come from a kernel but from tables. Where there is none for these
   parameters, which 0 says, the first stands in: `settle` may have more to say about them. */
static int look_up(Fmu *f)
{
    if (!MODEL.key_count) return 1;
    clear(f->words, MODEL.derived, MODEL.told);
    for (const Table *t = MODEL.tables; t < MODEL.tables + MODEL.table_count; t++) {
        uint32_t k = 0;
        while (k < MODEL.key_count && fmu_whole(f->words + MODEL.keys[k]) == t->values[k]) k++;
        if (k < MODEL.key_count) continue;
        put(f->words, t->words, t->count);
        return 1;
    }
    put(f->words, MODEL.tables->words, MODEL.tables->count);
    return 0;
}

/* Compute from the parameters what follows from them. */
static Status derive(Fmu *f)
{
    f->outdated = 1;
    if (check_bounds(f, PARAMETER)) return ERROR;
    int held = look_up(f);
    int64_t problem = settle(f->words);
    if (problem < 0 || problem > MODEL.problem_count) return fmu_explain(f, SAY_GAVE_UP, f->life.end);
    if (problem) {
        const Problem *p = &MODEL.problems[problem - 1];
        const double *told = f->words + MODEL.told;
        return fmu_explain(f, p->format, told[p->told[0]], told[p->told[1]], told[p->told[2]], told[p->told[3]]);
    }
    if (!held) return refuse_choice(f);
    memcpy(f->settled, f->words + MODEL.parameters, (MODEL.inputs - MODEL.parameters) * sizeof(double));
    f->outdated = 0;
    return OK;
}

/* The same for a started model, whose state has more in use than `settle` knows of: it stays what it is. */
static Status derive_again(Fmu *f)
{
    const size_t size = MODEL.derived * sizeof(double);
    double *kept = malloc(size);
    if (!kept) return fmu_explain(f, SAY_NO_MEMORY);
    memcpy(kept, f->words, size);
    Status status = derive(f);
    memcpy(f->words, kept, size);
    free(kept);
    return status;
}

/* State and outputs from parameters and inputs; what is wrong is noted, no more. */
static Status refresh(Fmu *f)
{
    if (derive(f) || check_bounds(f, INPUT)) return ERROR;
    clear(f->words, MODEL.outputs, MODEL.weights);
    put(f->words, MODEL.begun, MODEL.begun_count);
    f->words[MODEL.time] = f->life.start;
    f->words[MODEL.evaluations] = 0.0; /* a whole number, whose zero is the same */
    if (start(f->words)) return fmu_explain(f, SAY_GAVE_UP, f->life.start);
    f->stale = 0;
    return OK;
}

/* -- life ---------------------------------------------------------------------------------------- */

static void begin(Fmu *f)
{
    memset(f->words, 0, MODEL.words * sizeof(double));
    put(f->words, MODEL.defaults, MODEL.default_count);
    f->life = (Life){.phase = NEW};
    free(f->why);
    f->why = NULL;
    f->stale = f->outdated = 1;
}

void fmu_free(Fmu *f)
{
    if (!f) return;
    free(f->words);
    free(f->scratch);
    free(f->settled);
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

Fmu *fmu_create(const char *name, const char *identity, Host host, const char *problem)
{
    Fmu *f = calloc(1, sizeof *f);
    if (!f) return NULL;
    f->host = host;
    size_t length = name ? strlen(name) + 1 : 1;
    f->name = calloc(length, 1);
    f->words = calloc(MODEL.words, sizeof(double));
    f->scratch = calloc(MODEL.scratch, sizeof(double));
    f->settled = calloc(MODEL.inputs - MODEL.parameters + 1, sizeof(double));
    if (!f->name || !f->words || !f->scratch || !f->settled) problem = SAY_NO_MEMORY;
    if (f->name && name) memcpy(f->name, name, length);
    if (!problem) problem = unusable(identity);
    if (problem) {
        fmu_explain(f, "%s", problem);
        tell(f, ERROR);
        fmu_free(f);
        return NULL;
    }
    begin(f);
    return f;
}

Status fmu_set_up(Fmu *f, double start_time)
{
    if (f->life.phase != NEW) return FAIL(f, SAY_SETUP_LATE);
    if (!isfinite(start_time)) return FAIL(f, SAY_NO_START, plain(start_time));
    f->life.start = start_time;
    f->stale = 1;
    return OK;
}

Status fmu_enter(Fmu *f)
{
    if (f->life.phase != NEW) return FAIL(f, SAY_ENTERED_TWICE);
    f->life.phase = INITIALISING;
    return OK;
}

Status fmu_leave(Fmu *f)
{
    if (f->life.phase != INITIALISING) return FAIL(f, SAY_NOT_ENTERED);
    if (f->life.failed) return stop_again(f);
    if (refresh(f)) return fmu_fail(f);
    f->life.phase = STEPPING;
    f->life.end = f->life.start;
    return OK;
}

Status fmu_end(Fmu *f)
{
    f->life.phase = ENDED;
    return OK;
}

Status fmu_reset(Fmu *f)
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
                return fmu_explain(f, SAY_BAD_INPUT, s->name, plain(f->words[s->index]), time);
    if (status == BAD_INPUT || status == BAD_LOAD) return fmu_explain(f, SAY_BAD_LOAD, time);
    if (status == RAISED) return fmu_explain(f, SAY_GAVE_UP, time);
    if (status == TOO_MANY_STEPS)
        fmu_explain(f, SAY_TOO_MANY_STEPS, MOST_STEPS, step, time);
    else
        fmu_explain(f, SAY_UNRESOLVED, time, step);
    return DISCARD;
}

Status fmu_step(Fmu *f, double time, double step)
{
    Life *life = &f->life;
    if (life->failed) return stop_again(f);
    if (life->phase != STEPPING) return FAIL(f, life->phase == ENDED ? SAY_ENDED : SAY_NOT_STARTED);
    if (fabs(time - life->end) > LATE * step) return FAIL(f, SAY_APART, time, step, life->end);
    if (!(step > 0.0) || !isfinite(step) || !isfinite(time)) return FAIL(f, SAY_NO_STEP, plain(time), plain(step));
    if (f->outdated && derive_again(f)) return fmu_fail(f);
    int64_t status = advance(f->words, f->scratch, time, step);
    if (status) return stop(f, explain_step(f, status, time, step));
    life->end = time + step;
    return OK;
}

/* -- values -------------------------------------------------------------------------------------- */

/* Whether each of the variables is of the kind in `needed`, and of one of its causalities. */
int fmu_allowed(const Reference *vr, size_t count, int needed)
{
    for (size_t i = 0; i < count; i++) {
        int access = vr[i] < MODEL.hidden ? MODEL.access[vr[i]] : 0;
        if (!(access & needed & (REAL | INTEGER))) return 0;
        if (!(access & needed & (PARAMETER | INPUT | OUTPUT | TUNABLE))) return 0;
    }
    return 1;
}

static int by_number(const void *one, const void *other)
{
    Reference a = *(const Reference *)one, b = *(const Reference *)other;
    return (a > b) - (a < b);
}

/* Names of the variables that are not `allowed`, in order, each once; NULL without memory. */
static char *others(const Reference *vr, size_t count, int needed)
{
    size_t length = 1;
    Reference *sorted = malloc(count * sizeof *sorted);
    char *names = calloc(1, 1);
    if (sorted) memcpy(sorted, vr, count * sizeof *sorted), qsort(sorted, count, sizeof *sorted, by_number);
    for (size_t i = 0; sorted && names && i < count; i++) {
        if (fmu_allowed(sorted + i, 1, needed) || (i && sorted[i] == sorted[i - 1])) continue;
        char unknown[64], *longer;
        const char *name = name_of(sorted[i]);
        snprintf(unknown, sizeof unknown, SAY_UNKNOWN, sorted[i]);
        if (!name) name = unknown;
        if ((longer = realloc(names, length + strlen(name) + 2))) {
            names = longer;
            length += (size_t)sprintf(names + length - 1, "%s%s", length > 1 ? ", " : "", name);
        }
    }
    free(sorted);
    return names;
}

Status fmu_refuse(Fmu *f, const char *format, const Reference *vr, size_t count, int needed, const char *kind)
{
    char *names = others(vr, count, needed);
    Status status = FAIL(f, format, names ? names : "", kind);
    free(names);
    return status;
}

/* What may be set now. */
int fmu_settable(const Fmu *f)
{
    return f->life.phase < STEPPING ? PARAMETER | INPUT : TUNABLE | INPUT;
}

/* Note that values were set. */
Status fmu_changed(Fmu *f, const Reference *vr, size_t count)
{
    f->stale = 1;
    if (f->life.phase >= STEPPING)
        for (size_t i = 0; i < count; i++) f->outdated |= !!(MODEL.access[vr[i]] & PARAMETER);
    return OK;
}

/* See that the variables of these kinds can be read and have values: outputs have none before initialisation
   is entered, and until it is complete they are made to follow from what was set. */
Status fmu_readable(Fmu *f, const Reference *vr, size_t count, int type, const char *kind)
{
    const int given = type | PARAMETER | INPUT, all = given | OUTPUT;
    if (!fmu_allowed(vr, count, all)) return fmu_refuse(f, SAY_UNREADABLE, vr, count, all, kind);
    if (f->life.phase >= STEPPING || fmu_allowed(vr, count, given)) return OK;
    if (f->life.phase == NEW) return fmu_refuse(f, SAY_READ_EARLY, vr, count, given, kind);
    return f->stale && refresh(f) ? fmu_fail(f) : OK;
}

/* -- state --------------------------------------------------------------------------------------- */

/* A saved state: whose it is, where the instance was, and the words up to the constants. */
static size_t state_size(void)
{
    return strlen(MODEL.guid) + sizeof(Life) + MODEL.derived * sizeof(double);
}

Status fmu_free_state(Fmu *f, Saved **state)
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

Status fmu_get_state(Fmu *f, Saved **state)
{
    const size_t identity = strlen(MODEL.guid);
    if (!room(state, state_size())) return FAIL(f, SAY_NO_MEMORY);
    char *to = (*state)->bytes;
    memcpy(to, MODEL.guid, identity);
    memcpy(to + identity, &f->life, sizeof f->life);
    memcpy(to + identity + sizeof f->life, f->words, MODEL.derived * sizeof(double));
    return OK;
}

Status fmu_set_state(Fmu *f, const Saved *state)
{
    const size_t identity = strlen(MODEL.guid);
    if (!state || state->size != state_size() || memcmp(state->bytes, MODEL.guid, identity))
        return FAIL(f, SAY_FOREIGN_STATE);
    memcpy(&f->life, state->bytes + identity, sizeof f->life);
    memcpy(f->words, state->bytes + identity + sizeof f->life, MODEL.derived * sizeof(double));
    if (!f->life.failed) {
        free(f->why);
        f->why = NULL;
    }
    f->stale = f->life.phase < STEPPING;
    f->outdated |= memcmp(f->settled, f->words + MODEL.parameters,
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

Status fmu_serialised_size(Fmu *f, const Saved *state, size_t *size)
{
    if (!state) return FAIL(f, SAY_FOREIGN_STATE);
    *size = state->size + sizeof(uint64_t);
    return OK;
}

Status fmu_serialise(Fmu *f, const Saved *state, char bytes[], size_t size)
{
    if (!state) return FAIL(f, SAY_FOREIGN_STATE);
    if (size < state->size + sizeof(uint64_t)) return FAIL(f, SAY_NO_ROOM);
    const uint64_t sum = checksum(state->bytes, state->size);
    memcpy(bytes, state->bytes, state->size);
    memcpy(bytes + state->size, &sum, sizeof sum);
    return OK;
}

Status fmu_deserialise(Fmu *f, const char bytes[], size_t size, Saved **state)
{
    const size_t own = state_size();
    if (!bytes || size != own + sizeof(uint64_t) || memcmp(bytes, MODEL.guid, strlen(MODEL.guid)))
        return FAIL(f, SAY_FOREIGN_STATE);
    const uint64_t sum = checksum(bytes, own);
    if (memcmp(bytes + own, &sum, sizeof sum)) return FAIL(f, SAY_FOREIGN_STATE);
    if (!room(state, own)) return FAIL(f, SAY_NO_MEMORY);
    memcpy((*state)->bytes, bytes, own);
    return OK;
}
