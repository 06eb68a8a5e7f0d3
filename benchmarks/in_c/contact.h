/* One contact: its place, what presses, and friction as a line over a kick. SI. */
#ifndef CONTACT_H
#define CONTACT_H

#include "bearing.h"

#include <math.h>

typedef struct { double x, y, vx, vy, spin; } Motion;
typedef struct { double nx, ny, indentation, first, second; } Place;
typedef struct { double start, slope, base; } Line; /* of friction: (start - slope ds)/base */
typedef struct { double sliding, rate, normal, damped; } Squeeze;
typedef struct { double across, along, sliding, rate; } Kick;
typedef struct { double fx, fy, first_moment, second_moment, normal, tangential, damped; } Press;

static const double INSIDE = 1.0, OUTSIDE = -1.0; /* of the second body lies the first */

static inline double larger(double a, double b) { return a > b ? a : b; }
static inline double smaller(double a, double b) { return a < b ? a : b; }

/* What a contact that asks for `elastic` (N) can give over a kick (s) from the energy `stored` (J); drift: half
   of the one that follows (s); scale: indentation over n + 1 (m). */
static inline double passive(double elastic, double scale, double stored, double rate, double others,
                             double answer, double kick, double drift)
{
    const double closing = rate + 0.5 * others;
    const double given = elastic * kick * (0.5 * answer * elastic - closing);
    const double left = elastic * (scale + drift * (rate + others - answer * elastic));
    const double reserve = drift > 0.0 ? 0.9 * larger(left, 0.0) : 0.0;
    const double most = larger(stored - reserve, 0.5 * given), held = larger(stored, 0.0);
    const double allowed = held < most ? held : most;
    const double gain = 2.0 * answer / larger(kick, 1e-300), inverse = 1.0 / larger(answer, 1e-300);
    const double root = sqrt(larger(closing * closing + gain * allowed, 0.0));
    const double within = larger((closing + root) * inverse, 0.0);
    return given > allowed ? (within < elastic ? within : elastic) : elastic;
}

/* Mean normal force (N) over a kick, never below zero. */
static inline double damped_normal(double elastic, double damping, double rate, double along, double others)
{
    const double z = along * damping;
    const double force = (6.0 + z) * (elastic + damping * rate) + (3.0 + z) * damping * others;
    return larger(force / (6.0 + z * (4.0 + z)), 0.0);
}

/* 1 - exp(-x): a series for exp(-x/1024), squared ten times. */
static inline double saturation(double x)
{
    const double z = smaller(x, 40.0) * (1.0 / 1024.0);
    double e = 1.0 - z * (1.0 - z * (1.0 / 2 - z * (1.0 / 6 - z * (1.0 / 24))));
    e = e * e;
    e = e * e;
    e = e * e;
    e = e * e;
    e = e * e;
    e = e * e;
    e = e * e;
    e = e * e;
    e = e * e;
    return 1.0 - e * e;
}

/* The speed (m/s) where a kick is expected to end under friction that rises linearly to its peak. */
static inline double spot(double expected, double answer, double normal, const Friction *law)
{
    const double steepest = law->dynamic * law->slope + law->g1 * (law->g2 - law->g3) + law->g6;
    const double highest = law->dynamic + 0.75 * law->g1;
    const double reach = answer * normal, size = fabs(expected);
    const double end = larger(size / (1.0 + reach * steepest), size - reach * highest);
    return expected >= 0.0 ? end : -end;
}

/* The line of friction under the force `normal` (N), through its value at `speed` (m/s), where the
   exponentials of both its rises have run as far as `last` and `flat`. */
static inline Line line_at(double speed, double last, double flat, double sliding, double answer,
                           double normal, const Friction *law)
{
    const double both = 1.0 / ((2.0 - last) * (2.0 - flat));
    const double rise = last * (2.0 - flat) * both, fall = flat * (2.0 - last) * both;
    double value = law->dynamic * rise, slope = law->dynamic * law->slope * (1.0 - rise * rise);
    value += law->g1 * (rise - fall);
    slope += law->g1 * (law->g2 * (1.0 - rise * rise) - law->g3 * (1.0 - fall * fall));
    value += law->g6 * fabs(speed);
    const double mu = speed >= 0.0 ? value : -value;
    slope = larger(slope + law->g6, 0.0) * normal;
    const double z = answer * slope;
    const Line line = {(6.0 + z) * (slope * (speed - sliding) - normal * mu), (3.0 + z) * slope, 6.0 + z};
    return line;
}

/* The same for a contact alone. */
static inline Line line_of(double sliding, double expected, double answer, double normal,
                           const Friction *law)
{
    const double speed = spot(expected, answer, normal, law), v = fabs(speed);
    const double last = saturation(2.0 * law->slope * v), flat = saturation(2.0 * law->g3 * v);
    return line_at(speed, last, flat, sliding, answer, normal, law);
}

/* Sliding speed and rate of the indentation (m/s) of two bodies at a place. */
static inline void slip(Motion first, Motion second, Place at, double side, double *sliding, double *rate)
{
    const double ux = first.vx - second.vx, uy = first.vy - second.vy;
    *sliding = uy * at.nx - ux * at.ny + first.spin * at.first - second.spin * at.second;
    *rate = side * (ux * at.nx + uy * at.ny);
}

static inline Kick kick_of(double h, double across, double along, Motion first, Motion second, Place at,
                           double side, double friction, double normal)
{
    Kick kick = {h * across, h * along, 0.0, 0.0};
    slip(first, second, at, side, &kick.sliding, &kick.rate);
    kick.sliding = h * kick.sliding - kick.across * friction;
    kick.rate = h * kick.rate + kick.along * normal;
    return kick;
}

static inline void elastic_and_damping(double indentation, const Law *law, double *elastic, double *damping)
{
    *elastic = *damping = 0.0;
    if (indentation <= 0.0) return;
    *elastic = law->stiffness * (indentation * sqrt(indentation));
    *damping = law->dissipation * *elastic + law->damping * indentation + law->viscous;
}

static inline Press rubbed(Place at, double side, Squeeze s, double friction)
{
    const double along = -side * s.normal;
    const Press press = {along * at.nx - friction * at.ny, along * at.ny + friction * at.nx,
                         at.first * friction, -(at.second * friction), s.normal, friction, s.damped};
    return press;
}

#endif
