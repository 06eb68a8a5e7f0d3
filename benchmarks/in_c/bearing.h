/* What the right-hand side works on, as structures of arrays; names are those of the project's own memory.
   `right_hand_side.py` fills in what it is given, by name, and reads the results. SI. */
#ifndef BEARING_H
#define BEARING_H

#include <stdint.h>

enum { MOST = 32, LANES = 8 }; /* balls there is room for, a multiple of the numbers taken at once */

/* Quadratures, copies of journal and housing, then the ring; in the order of the project's state. */
enum {
    JPX, JPY, JPM, JQX, JQY, JQM, JE, HPX, HPY, HE, LOSS,
    JX, JY, JVX, JVY, JW, HX, HY, HVX, HVY, HFX, HFY, HFVX, HFVY,
    RX, RY, RVX, RVY, RANGLE, RW, HEAD = 32
};

typedef struct { double x[MOST], y[MOST], vx[MOST], vy[MOST], angle[MOST], spin[MOST]; } Balls;
typedef struct { double x, y, vx, vy, angle, spin, spare[2]; } Cage;
typedef struct { double head[HEAD]; Cage cage; Balls balls; } State; /* or its derivative */

typedef struct { /* all balls at one race; the first two are those of the kick before, on entry */
    double normal[MOST], tangential[MOST], indentation[MOST], stiffness[MOST], loss[MOST];
    double nx[MOST], ny[MOST], second[MOST], sliding[MOST], rate[MOST], damped[MOST], driven[MOST];
    double expected[MOST], start[MOST], slope[MOST], base[MOST], held[MOST], gain[MOST];
    double middle[MOST], stored[MOST];
} Race;

typedef struct { /* each ball and the next one, or its pocket in the cage */
    double normal[MOST], highest[MOST], tangential[MOST], indentation[MOST], stiffness[MOST];
    double nx[MOST], ny[MOST], first[MOST], second[MOST], sliding[MOST], rate[MOST], damped[MOST];
    double middle[MOST], stored[MOST];
} Side;

typedef struct { /* those contacts on their way through a kick */
    double elastic[MOST], driven[MOST], across[MOST], base[MOST], pull[MOST], free[MOST];
} Chain;

typedef struct { /* contacts at races that press, one behind the other, and the line of their friction */
    double normal[2 * MOST], sliding[2 * MOST], expected[2 * MOST], answer[2 * MOST];
    double spot[2 * MOST], last[2 * MOST], flat[2 * MOST];
    double start[2 * MOST], slope[2 * MOST], base[2 * MOST];
} Lines;

typedef struct { double x[MOST], y[MOST], spin[MOST]; } Rates;
typedef struct { double normal, indentation, rate, elastic, middle, nx, ny, stored; } Touched;
typedef struct { double jx, jy, jm, hx, hy; } Brake;
typedef struct { double stiffness, damping, dissipation, viscous; } Law; /* exponent 1.5 */
typedef struct { double g1, g2, g3, dynamic, slope, g6; } Friction; /* Makkar's, g2 = slope */
typedef struct { double ax_free, ay_free, inv_m, alpha_free, inv_I; } Journal;
typedef struct { double x, y, vx, vy, ax_free, ay_free, inv_m, k_over_m, c_over_m; } Housing;

typedef struct {
    Race inner, outer;
    Side side;
    Chain chain;
    Lines lines;
    Rates faster;
    double cross[MOST], pocket_x[MOST], pocket_y[MOST];
    State before; /* derivative in the kick before */
    double kick, drift, rubbed, ahead[5], half;
    Touched ring;
    Brake brake;
    double gravity, journal_radius, clearance, ring_mass, ring_inertia;
    double mass, inertia, ball_radius, inner_radius, outer_radius;
    double cage_mass, cage_inertia, cage_clearance;
    Law inner_law, outer_law, contact, side_contact;
    Friction friction, race_friction, side_friction;
    Journal journal;
    Housing housing;
    int64_t count, caged;
} Bearing;

/* How many balls the loops run over: what lies past the last one does not matter. */
static inline int64_t in_full(int64_t count) { return (count + LANES - 1) / LANES * LANES; }

#endif
