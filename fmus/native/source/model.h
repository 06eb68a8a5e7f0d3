/* A model as the FMI side sees it: tables, written from its declarations, and three functions.
   All memory of an instance is one array of 8-byte words (touchdown.modelkit.model); a value reference is
   a place in it. */
#ifndef MODEL_H
#define MODEL_H

#include <stddef.h>
#include <stdint.h>

enum { REAL = 1, INTEGER = 2, PARAMETER = 4, INPUT = 8, OUTPUT = 16 }; /* a kind and a causality */
enum { TUNABLE = 32, INDEPENDENT = 64 }; /* a parameter that may be set between steps; the time */

typedef struct {
    const char *name, *unit; /* the unit with a space before it, or empty */
    double above, minimum, maximum;
    uint32_t index;
    uint8_t access;
} Slot;

typedef struct { /* where an array's elements lie: how many, and words from one to the next */
    uint32_t count, stride;
} Extent;

typedef struct { /* a word that is not zero */
    uint32_t index;
    uint64_t bits;
} Word;

typedef struct { /* a text of printf's, and which of m.message_numbers stand in it */
    const char *format;
    uint8_t numbers[4];
} Problem;

typedef struct { /* constants for some values of the parameters they hang on */
    const int64_t *values;
    const Word *words;
    uint32_t count;
} Table;

typedef struct {
    const char *guid;
    const Slot *slots;
    const uint8_t *access;             /* of each word before `hidden` */
    const Extent *extents;             /* of the same, of FMI 3.0 only */
    const Word *defaults;              /* of a fresh instance */
    const Word *begun;                 /* of outputs and hidden memory when it starts */
    const Problem *problems;           /* what `derive` finds, from number 1 on */
    const uint32_t *keys;              /* parameters that tables hang on */
    const Table *tables;
    const char *held;                  /* what there are tables for, in words */
    uint32_t slot_count, default_count, begun_count, problem_count, key_count, table_count;
    uint32_t words, scratch;           /* sizes, in words */
    uint32_t parameters, inputs, outputs, hidden, weights, derived, message_numbers; /* where parts begin */
    uint32_t time, h, evaluations;
} Model;

extern const Model MODEL;

/* They return 0, or what went wrong: `derive` the number of a problem, `advance` one of the statuses in
   texts.h, and any of them RAISED where the code gave up. */
enum { RAISED = -1 };
int64_t derive(double *words);
int64_t start(double *words);
int64_t advance(double *words, double *scratch, double time, double step);

#endif
