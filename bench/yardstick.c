/* The yardstick: the kernel's method written by hand in C for the five-pulley rig alone.

   RODAS4 on the reduced system, hybrid sticking and sliding with located events, slackening cables,
   a wall, PID at 1 kHz or continuous. Topology, sizes and the order of elimination are fixed, as a
   C programmer would have it who never needs another instrument: pulleys M, 1, 2, 3, L; loops M-1,
   1-2-3, L-3. With -DSMOOTH=1 friction is regularised, v / sqrt(v^2 + eps^2), and never sticks. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifndef SMOOTH
#define SMOOTH 0
#endif

enum { N = 5, LOOPS = 3, MOTORS = 2, FULL = 12, ROW = 22 };
enum { PM, P1, P2, P3, PL };
enum { SLIDE, STICK, MEET, SLACKEN };

typedef struct {
    double inertia[N], damping[N], friction[N];
    double rM, r1a, r1b, r3b, r2b, rL, r3c; /* signed radii, by loop */
    double preload[LOOPS], curve_start, curve_rate;
    double contact_arm, contact_position, contact_stiffness, contact_damping;
    double kp[MOTORS], ki[MOTORS], kd[MOTORS], limit[MOTORS];
    double period, tolerance, eps;
    long cells, contact_law;
} Rig;

typedef struct {
    double delta[LOOPS], tension[LOOPS], slope[LOOPS], total[LOOPS], total_d[LOOPS], slack[LOOPS];
    double gap, force, force_q, force_v;
    double input[N], torque[N], own[N], speed[N], side[N], budget[N], f[FULL], command[MOTORS];
    double free[MOTORS];
    /* kept over a step */
    double j_loop[LOOPS], j_total[LOOPS], j_grip[7], j_own[N], j_speed[N], j_q, j_v, j_free[MOTORS];
    double first[FULL], outer[FULL], start[FULL], next[FULL], trial[FULL], u[6][FULL], right[FULL];
    double slack_start[LOOPS];
    /* the factorised matrix */
    double dM, d1, d2, d3, dL, m1, am, a12, a13, a21, a31, a23, a32, al, l3, pre;
    int mode[N], touch, continuous, size;
    long steps, rejected, events;
    const double *signal;
    long samples;
} Work;

static const double GAMMA = 0.25;
static const double A[6][5] = {
    {0},
    {1.544},
    {0.9466785280815826, 0.2557011698983284},
    {3.314825187068521, 2.896124015972201, 0.9986419139977817},
    {1.221224509226641, 6.019134481288629, 12.53708333932087, -0.687886036105895},
    {1.221224509226641, 6.019134481288629, 12.53708333932087, -0.687886036105895, 1.0}};
static const double C[6][5] = {
    {0},
    {-5.6688},
    {-2.430093356833875, -0.2063599157091915},
    {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
    {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.7089089320616},
    {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136,
     -6.058818238834054}};
static const double T[6] = {0.0, 0.386, 0.21, 0.63, 1.0, 1.0};
static const double G[6] = {0.25, -0.1043, 0.1035, -0.03620000000000023, 0.0, 0.0};
static const double D2[5] = {10.12623508344586, -7.487995877610167, -34.80091861555747,
                             -7.992771707568823, 1.025137723295662};
static const double D3[5] = {-0.6762803392801253, 6.087714651680015, 16.43084320892478,
                             24.76722511418386, -6.594389125716872};

static inline double clip(double v, double lo, double hi) { return v < lo ? lo : v > hi ? hi : v; }

static inline double cable(const Rig *r, const double *table, double x, double *slope)
{
    double u = (x - r->curve_start) * r->curve_rate, beyond = 0.0;
    if (u <= 0.0) {
        *slope = 0.0;
        return table[0];
    }
    long cell = (long)u;
    if (cell < r->cells) {
        u -= cell;
    } else {
        cell = r->cells - 1;
        beyond = u - r->cells;
        u = 1.0;
    }
    const double *p = table + 4 * cell;
    double s = p[1] + u * (2.0 * p[2] + 3.0 * u * p[3]);
    *slope = s * r->curve_rate;
    return p[0] + u * (p[1] + u * (p[2] + u * p[3])) + beyond * s;
}

/* set-point j at time t with two derivatives: cubic Hermite at the controller's period */
static inline double wish(const Rig *r, const Work *w, int j, double t, double *d1, double *d2)
{
    const double *v = w->signal + j * w->samples, *s = w->signal + (MOTORS + j) * w->samples;
    double u = t / r->period;
    *d1 = *d2 = 0.0;
    if (u <= 0.0) return v[0];
    if (u >= w->samples - 1) return v[w->samples - 1];
    long cell = (long)u;
    u -= cell;
    double p = s[cell] * r->period, q = s[cell + 1] * r->period, rise = v[cell + 1] - v[cell];
    double b = 3.0 * rise - 2.0 * p - q, e = p + q - 2.0 * rise;
    *d1 = (p + u * (2.0 * b + 3.0 * u * e)) / r->period;
    *d2 = (2.0 * b + 6.0 * u * e) / (r->period * r->period);
    return v[cell] + u * (p + u * (b + u * e));
}

static void evaluate(const Rig *r, const double *table, Work *w, double t, const double *y)
{
    const double *th = y, *om = y + N;
    w->delta[0] = r->rM * th[PM] + r->r1a * th[P1];
    w->delta[1] = r->r1b * th[P1] + r->r3b * th[P3] + r->r2b * th[P2];
    w->delta[2] = r->rL * th[PL] + r->r3c * th[P3];
    for (int k = 0; k < LOOPS; k++) {
        double sa, sb, x = w->delta[k];
        double ta = cable(r, table, r->preload[k] + x, &sa);
        double tb = cable(r, table, r->preload[k] - x, &sb);
        w->tension[k] = ta - tb;
        w->slope[k] = sa + sb;
        w->total[k] = ta + tb;
        w->total_d[k] = sa - sb;
        w->slack[k] = r->preload[k] - r->curve_start - fabs(x);
    }
    double q = th[P2] - r->contact_position, v = om[P2];
    double stiff = r->contact_stiffness * r->contact_arm, damp = r->contact_damping * r->contact_arm;
    double force, by_q, by_v;
    if (r->contact_law == 0) {
        force = stiff * q + damp * v;
        by_q = stiff;
        by_v = damp;
        w->gap = fmin(q, force / stiff);
    } else {
        force = stiff * q * (1.0 + damp * v);
        by_q = stiff * (1.0 + damp * v);
        by_v = stiff * q * damp;
        w->gap = fmin(q, 1.0 + damp * v);
    }
    w->force = w->touch ? force : 0.0;
    w->force_q = w->touch ? by_q : 0.0;
    w->force_v = w->touch ? by_v : 0.0;
    for (int i = 0; i < N; i++) {
        w->own[i] = 0.0;
        w->speed[i] = -r->damping[i];
    }
    if (w->continuous)
        for (int j = 0; j < MOTORS; j++) {
            int i = j ? PL : PM;
            double d1, d2, target = wish(r, w, j, t, &d1, &d2), error = target - th[i];
            double ask = r->kp[j] * error + r->ki[j] * y[2 * N + j] + r->kd[j] * (d1 - om[i]);
            double give = clip(ask, -r->limit[j], r->limit[j]);
            w->command[j] = w->input[i] = give;
            w->free[j] = ask == give;
            w->own[i] -= w->free[j] * r->kp[j];
            w->speed[i] -= w->free[j] * r->kd[j];
            w->f[2 * N + j] = w->free[j] * error;
        }
    double a = w->tension[0], b = w->tension[1], c = w->tension[2];
    w->torque[PM] = w->input[PM] - r->damping[PM] * om[PM] - r->rM * a;
    w->torque[P1] = -r->damping[P1] * om[P1] - r->r1a * a - r->r1b * b;
    w->torque[P2] = -r->damping[P2] * om[P2] - r->r2b * b - r->contact_arm * w->force;
    w->torque[P3] = -r->damping[P3] * om[P3] - r->r3b * b - r->r3c * c;
    w->torque[PL] = w->input[PL] - r->damping[PL] * om[PL] - r->rL * c;
    double load[N];
    load[PM] = fabs(r->rM) * w->total[0];
    load[P1] = fabs(r->r1a) * w->total[0] + fabs(r->r1b) * w->total[1];
    load[P2] = fabs(r->r2b) * w->total[1];
    load[P3] = fabs(r->r3b) * w->total[1] + fabs(r->r3c) * w->total[2];
    load[PL] = fabs(r->rL) * w->total[2];
    for (int i = 0; i < N; i++) {
        w->budget[i] = r->friction[i] * load[i];
#if SMOOTH
        double root = 1.0 / sqrt(om[i] * om[i] + r->eps * r->eps);
        w->side[i] = -om[i] * root;
        w->speed[i] -= w->budget[i] * r->eps * r->eps * root * root * root;
#else
        w->side[i] = w->mode[i] == 2 ? 0.0 : -w->mode[i];
#endif
        w->f[i] = om[i];
        w->f[N + i] =
            w->mode[i] == 0 ? 0.0 : (w->torque[i] + w->side[i] * w->budget[i]) / r->inertia[i];
    }
}

static void state_at(const Rig *r, const double *table, Work *w, double t, const double *y)
{
    int freed = 0;
    evaluate(r, table, w, t, y);
    for (int i = 0; i < N; i++)
        if (w->mode[i] == 0 && fabs(w->torque[i]) > w->budget[i]) {
            w->mode[i] = w->torque[i] > 0.0 ? 1 : -1;
            freed = 1;
        }
    if (freed) evaluate(r, table, w, t, y);
}

static void linearise(const Rig *r, Work *w, double t)
{
    memcpy(w->j_loop, w->slope, sizeof w->slope);
    memcpy(w->j_total, w->total_d, sizeof w->total_d);
    memcpy(w->j_own, w->own, sizeof w->own);
    memcpy(w->j_speed, w->speed, sizeof w->speed);
    memcpy(w->j_free, w->free, sizeof w->free);
    memcpy(w->first, w->f, sizeof w->f);
    memcpy(w->slack_start, w->slack, sizeof w->slack);
    w->j_grip[0] = w->side[PM] * r->friction[PM] * fabs(r->rM);
    w->j_grip[1] = w->side[P1] * r->friction[P1] * fabs(r->r1a);
    w->j_grip[2] = w->side[P1] * r->friction[P1] * fabs(r->r1b);
    w->j_grip[3] = w->side[P3] * r->friction[P3] * fabs(r->r3b);
    w->j_grip[4] = w->side[P2] * r->friction[P2] * fabs(r->r2b);
    w->j_grip[5] = w->side[P3] * r->friction[P3] * fabs(r->r3c);
    w->j_grip[6] = w->side[PL] * r->friction[PL] * fabs(r->rL);
    w->j_q = r->contact_arm * w->force_q;
    w->j_v = r->contact_arm * w->force_v;
    memset(w->outer, 0, sizeof w->outer);
    if (w->continuous)
        for (int j = 0; j < MOTORS; j++)
            if (w->free[j] != 0.0) {
                int i = j ? PL : PM;
                double d1, d2;
                wish(r, w, j, t, &d1, &d2);
                w->outer[N + i] = (r->kp[j] * d1 + r->kd[j] * d2) / r->inertia[i];
                w->outer[2 * N + j] = d1;
            }
}

/* rows: what a unit of elongation rate does to each pulley, by loop */
static void factor(const Rig *r, Work *w, double h)
{
    double p = 1.0 / (GAMMA * h), per = GAMMA * h, d[N];
    for (int i = 0; i < N; i++) d[i] = r->inertia[i] * p - w->j_own[i] * per - w->j_speed[i];
    if (w->continuous)
        for (int j = 0; j < MOTORS; j++)
            d[j ? PL : PM] += w->j_free[j] * w->j_free[j] * r->ki[j] * per * per;
    double ka = w->j_loop[0] * per, kb = w->j_loop[1] * per, kc = w->j_loop[2] * per;
    double sa = w->j_total[0] * per, sb = w->j_total[1] * per, sc = w->j_total[2] * per;
    const double *g = w->j_grip;
    double wM = r->rM * ka - g[0] * sa, w1 = r->r1a * ka - g[1] * sa;
    double v1 = r->r1b * kb - g[2] * sb, v3 = r->r3b * kb - g[3] * sb, v2 = r->r2b * kb - g[4] * sb;
    double x3 = r->r3c * kc - g[5] * sc, xL = r->rL * kc - g[6] * sc;
    double am = wM * r->r1a, m1 = w1 * r->rM, al = xL * r->r3c, l3 = x3 * r->rL;
    double a12 = v1 * r->r2b, a13 = v1 * r->r3b, a21 = v2 * r->r1b, a23 = v2 * r->r3b;
    double a31 = v3 * r->r1b, a32 = v3 * r->r2b;
    d[PM] += wM * r->rM;
    d[P1] += w1 * r->r1a + v1 * r->r1b;
    d[P2] += v2 * r->r2b + w->j_q * per + w->j_v;
    d[P3] += v3 * r->r3b + x3 * r->r3c;
    d[PL] += xL * r->rL;
    if (w->mode[P1] == 0) {
        d[P1] = 1.0;
        m1 = a12 = a13 = 0.0;
    }
    if (w->mode[P2] == 0) {
        d[P2] = 1.0;
        a21 = a23 = 0.0;
    }
    if (w->mode[P3] == 0) {
        d[P3] = 1.0;
        l3 = a31 = a32 = 0.0;
    }
    if (w->mode[PM] == 0) {
        d[PM] = 1.0;
        am = 0.0;
    }
    if (w->mode[PL] == 0) {
        d[PL] = 1.0;
        al = 0.0;
    }
    /* M and L go first and touch one neighbour each; then 2, 1, 3 */
    w->dM = 1.0 / d[PM];
    w->dL = 1.0 / d[PL];
    w->m1 = m1 * w->dM;
    w->l3 = l3 * w->dL;
    w->am = am;
    w->al = al;
    d[P1] -= w->m1 * am;
    d[P3] -= w->l3 * al;
    w->d2 = 1.0 / d[P2];
    w->a12 = a12 * w->d2;
    w->a32 = a32 * w->d2;
    w->a21 = a21;
    w->a23 = a23;
    d[P1] -= w->a12 * a21;
    a13 -= w->a12 * a23;
    a31 -= w->a32 * a21;
    d[P3] -= w->a32 * a23;
    w->d1 = 1.0 / d[P1];
    w->a31 = a31 * w->d1;
    w->a13 = a13;
    w->d3 = 1.0 / (d[P3] - w->a31 * a13);
}

static void solve(const Rig *r, Work *w, double h, double *out)
{
    double per = GAMMA * h, b[N];
    const double *ra = w->right, *rv = w->right + N, *g = w->j_grip;
    for (int i = 0; i < N; i++) b[i] = r->inertia[i] * rv[i] + w->j_own[i] * ra[i] * per;
    if (w->continuous)
        for (int j = 0; j < MOTORS; j++) {
            int i = j ? PL : PM;
            double z = w->right[2 * N + j] - w->j_free[j] * ra[i] * per;
            b[i] += w->j_free[j] * r->ki[j] * z * per;
        }
    double xa = (r->rM * ra[PM] + r->r1a * ra[P1]) * per;
    double xb = (r->r1b * ra[P1] + r->r3b * ra[P3] + r->r2b * ra[P2]) * per;
    double xc = (r->rL * ra[PL] + r->r3c * ra[P3]) * per;
    double ka = w->j_loop[0] * xa, kb = w->j_loop[1] * xb, kc = w->j_loop[2] * xc;
    double sa = w->j_total[0] * xa, sb = w->j_total[1] * xb, sc = w->j_total[2] * xc;
    b[PM] += g[0] * sa - r->rM * ka;
    b[P1] += g[1] * sa - r->r1a * ka + g[2] * sb - r->r1b * kb;
    b[P3] += g[3] * sb - r->r3b * kb + g[5] * sc - r->r3c * kc;
    b[P2] += g[4] * sb - r->r2b * kb - w->j_q * per * ra[P2];
    b[PL] += g[6] * sc - r->rL * kc;
    for (int i = 0; i < N; i++)
        if (w->mode[i] == 0) b[i] = 0.0;
    b[P1] -= w->m1 * b[PM];
    b[P3] -= w->l3 * b[PL];
    b[P1] -= w->a12 * b[P2];
    b[P3] -= w->a32 * b[P2];
    b[P3] -= w->a31 * b[P1];
    b[P3] *= w->d3;
    b[P1] = (b[P1] - w->a13 * b[P3]) * w->d1;
    b[P2] = (b[P2] - w->a21 * b[P1] - w->a23 * b[P3]) * w->d2;
    b[PL] = (b[PL] - w->al * b[P3]) * w->dL;
    b[PM] = (b[PM] - w->am * b[P1]) * w->dM;
    for (int i = 0; i < N; i++) {
        out[N + i] = b[i];
        out[i] = (ra[i] + b[i]) * per;
    }
    if (w->continuous)
        for (int j = 0; j < MOTORS; j++)
            out[2 * N + j] = (w->right[2 * N + j] - w->j_free[j] * out[j ? PL : PM]) * per;
}

static double step(const Rig *r, const double *table, Work *w, double t, double h)
{
    double per = 1.0 / h;
    int size = w->size;
    factor(r, w, h);
    memcpy(w->f, w->first, sizeof w->f);
#pragma GCC unroll 6
    for (int s = 0; s < 6; s++) {
        if (s) {
            for (int n = 0; n < size; n++) {
                double y = w->start[n];
                for (int o = 0; o < s; o++) y += A[s][o] * w->u[o][n];
                w->trial[n] = y;
            }
            evaluate(r, table, w, t + T[s] * h, w->trial);
        }
        for (int n = 0; n < size; n++) {
            double sum = 0.0;
            for (int o = 0; o < s; o++) sum += C[s][o] * w->u[o][n];
            w->right[n] = w->f[n] + h * G[s] * w->outer[n] + per * sum;
        }
        for (int i = 0; i < N; i++)
            if (w->mode[i] == 0) {
                double sum = 0.0;
                for (int o = 0; o < s; o++) sum += C[s][o] * w->u[o][i];
                w->right[i] = per * sum;
            }
        solve(r, w, h, w->u[s]);
    }
    double total = 0.0, reach = h < 0.01 ? h : 0.01;
    for (int n = 0; n < size; n++) w->next[n] = w->trial[n] + w->u[5][n];
    for (int i = 0; i < N; i++) {
        double a = w->u[5][i], b = w->u[5][N + i] * reach;
        total += a * a + b * b;
    }
    total /= r->tolerance * r->tolerance;
    for (int n = 2 * N; n < size; n++) total += w->u[5][n] * w->u[5][n] * 1e10;
    return sqrt(total / size);
}

static void between(Work *w, double part, double *out)
{
    double rest = 1.0 - part;
    for (int n = 0; n < w->size; n++) {
        double a = 0.0, b = 0.0;
        for (int o = 0; o < 5; o++) {
            a += D2[o] * w->u[o][n];
            b += D3[o] * w->u[o][n];
        }
        out[n] = rest * w->start[n] + part * (w->next[n] + rest * (a + part * b));
    }
}

static double due(const Work *w, int kind, int i, const double *y)
{
    if (kind == SLIDE) return w->mode[i] * y[N + i];
    if (kind == STICK) return w->budget[i] - fabs(w->torque[i]);
    if (kind == MEET) return w->touch ? w->gap : -w->gap;
    return w->slack_start[i] > 0.0 ? w->slack[i] : -w->slack[i];
}

static double locate(const Rig *r, const double *table, Work *w, double t, double h, int kind, int i,
                     double last)
{
    double low = 1e-6, high = 1.0, part = 1.0;
    between(w, low, w->trial);
    evaluate(r, table, w, t + low * h, w->trial);
    double value = due(w, kind, i, w->trial);
    if (value <= 0.0) return low;
    for (int n = 0; n < 12; n++) {
        part = (value * high - last * low) / (value - last);
        between(w, part, w->trial);
        if (kind != SLIDE) evaluate(r, table, w, t + part * h, w->trial);
        double now = due(w, kind, i, w->trial);
        if (now > 0.0) {
            low = part;
            value = now;
            last *= 0.5;
        } else {
            high = part;
            last = now;
            value *= 0.5;
        }
        if (high - low < 1e-9 || fabs(now) < 1e-13) break;
    }
    return part;
}

static double crossing(const Rig *r, const double *table, Work *w, double t, double h, int *kind,
                       int *index)
{
    double pending[N + 1 + LOOPS], first = 2.0;
    for (int i = 0; i < N; i++)
        pending[i] = w->mode[i] == 2 ? 1.0 : due(w, w->mode[i] ? SLIDE : STICK, i, w->next);
    pending[N] = due(w, MEET, 0, w->next);
    for (int k = 0; k < LOOPS; k++) {
        double value = due(w, SLACKEN, k, w->next);
        pending[N + 1 + k] = fabs(w->slack_start[k]) > 1e-9 && value < -1e-9 ? value : 1.0;
    }
    for (int n = 0; n < N + 1 + LOOPS; n++)
        if (pending[n] < 0.0) {
            int what = n < N ? (w->mode[n] ? SLIDE : STICK) : n == N ? MEET : SLACKEN;
            int which = n < N ? n : n == N ? 0 : n - N - 1;
            double part = locate(r, table, w, t, h, what, which, pending[n]);
            if (part < first) {
                first = part;
                *kind = what;
                *index = which;
            }
        }
    return first;
}

static void change(const Rig *r, const double *table, Work *w, double t, int kind, int i)
{
    if (kind == SLIDE) {
        w->next[N + i] = 0.0;
        w->mode[i] = 0;
    } else if (kind == STICK) {
        w->mode[i] = w->torque[i] > 0.0 ? 1 : -1;
    } else if (kind == MEET) {
        w->touch = !w->touch;
    }
    state_at(r, table, w, t, w->next);
}

static void record(const Work *w, double t, const double *y, double *row)
{
    static const int order[N] = {PM, PL, P1, P2, P3};
    row[0] = t;
    for (int i = 0; i < N; i++) {
        row[1 + i] = y[order[i]];
        row[1 + N + i] = y[N + order[i]];
    }
    for (int j = 0; j < MOTORS; j++) row[11 + j] = w->command[j];
    for (int k = 0; k < LOOPS; k++) row[13 + k] = w->tension[k];
    row[16] = w->force;
    row[17] = y[PM];
    row[18] = y[PL];
    row[19] = w->command[0];
    row[20] = w->command[1];
    row[21] = w->force;
}

/* Advance to `end`; with rows given, write one for each period that a step has passed. */
/* Along signals, what stands still may soon move: see kernel/motion.py. */
static double longest(const Work *w) {
    if (!w->continuous) return 1e300;
    for (int i = 0; i < N; i++)
        if (w->mode[i] == 0) return 0.005;
    return 0.05;
}

static int advance(const Rig *r, const double *table, Work *w, double *clock, double end,
                   double *suggested, double *rows, long *tick, long every)
{
    double t = *clock;
    long steps = 0;
    while (t < end - 1e-10) {
        if (++steps > 200000) return 1;
        linearise(r, w, t);
        double whole = end - t, h = fmin(fmin(*suggested, whole), longest(w));
        if (h > 0.7 * whole && h < whole) h = 0.6 * whole;
        double error = step(r, table, w, t, h);
        while (!(error <= 1.0)) {
            w->rejected++;
            h *= error < 1e300 ? clip(0.9 / sqrt(sqrt(error)), 0.1, 0.7) : 0.1;
            if (h < 1e-10) return 1;
            error = step(r, table, w, t, h);
        }
        double grown = h * clip(0.9 / sqrt(sqrt(error + 1e-10)), 0.2, 5.0);
        *suggested = h == whole ? fmax(grown, *suggested) : grown;
        w->steps++;
        evaluate(r, table, w, t + h, w->next);
        int kind = -1, index = -1;
        double part = crossing(r, table, w, t, h, &kind, &index);
        while (part < 2.0) {
            double whole_step = h;
            h *= part;
            step(r, table, w, t, h);
            evaluate(r, table, w, t + h, w->next);
            if (kind == SLIDE) {
                double pace = w->f[N + index], miss = w->next[N + index];
                if (fabs(miss) > 1e-12 && fabs(miss) < 0.5 * h * fabs(pace)) {
                    h -= miss / pace;
                    step(r, table, w, t, h);
                    evaluate(r, table, w, t + h, w->next);
                }
            }
            // a pulley that gathers speed does not stop
            if (kind != SLIDE || whole_step < 1e-8 || !(w->mode[index] * w->f[N + index] > 0.0))
                break;
            h = 0.1 * whole_step;
            step(r, table, w, t, h);
            evaluate(r, table, w, t + h, w->next);
            part = crossing(r, table, w, t, h, &kind, &index);
        }
        w->events += part < 2.0;
        if (rows) {
            double at = (*tick + 1) * r->period;
            int looked = 0;
            while (at <= t + h + 1e-10) {
                ++*tick;
                if (*tick % every == 0) {
                    between(w, fmin((at - t) / h, 1.0), w->trial);
                    evaluate(r, table, w, at, w->trial);
                    record(w, at, w->trial, rows + ROW * (*tick / every));
                    looked = 1;
                }
                at = (*tick + 1) * r->period;
            }
            if (looked && part >= 2.0) evaluate(r, table, w, t + h, w->next);
        }
        t = h < whole || part < 2.0 ? t + h : end;
        if (part < 2.0) change(r, table, w, t, kind, index);
        memcpy(w->start, w->next, sizeof w->next);
        if (!(fabs(w->start[0]) < 1e6)) return 1;
    }
    *clock = end;
    return 0;
}

static void settle(const Rig *r, const double *table, Work *w)
{
    for (int i = 0; i < N; i++) w->mode[i] = SMOOTH || r->friction[i] == 0.0 ? 2 : 0;
    state_at(r, table, w, 0.0, w->start);
    if (w->gap > 1e-12) {
        w->touch = 1;
        state_at(r, table, w, 0.0, w->start);
    }
}

/* From rest, `ticks` periods; counts: steps, rejected, events. Set-points: values by motor, and for
   continuous control their slopes after them. */
int rollout(const Rig *r, const double *table, const double *setpoint, long ticks, long continuous,
            long every, double *rows, long *counts)
{
    Work *w = calloc(1, sizeof *w);
    double clock = 0.0, suggested = 0.1 * r->period, sum[MOTORS] = {0}, past[MOTORS];
    int status = 0;
    long tick = 0;
    w->continuous = (int)continuous;
    w->size = continuous ? FULL : 2 * N;
    w->signal = setpoint;
    w->samples = continuous ? ticks + 1 : ticks;
    settle(r, table, w);
    if (continuous) {
        record(w, 0.0, w->start, rows);
        status = advance(r, table, w, &clock, ticks * r->period, &suggested, rows, &tick, every);
    } else {
        for (tick = 0; tick < ticks && !status; tick++) {
            for (int j = 0; j < MOTORS; j++) {
                int i = j ? PL : PM;
                double error = setpoint[j * ticks + tick] - w->start[i];
                if (tick == 0) past[j] = error;
                double total = sum[j] + r->period * error;
                double rate = (error - past[j]) / r->period;
                past[j] = error;
                double ask = r->kp[j] * error + r->ki[j] * total + r->kd[j] * rate;
                double give = clip(ask, -r->limit[j], r->limit[j]);
                if (ask == give) sum[j] = total;
                w->command[j] = w->input[i] = give;
            }
            state_at(r, table, w, clock, w->start);
            if (tick % every == 0) record(w, clock, w->start, rows + ROW * (tick / every));
            status = advance(r, table, w, &clock, (tick + 1) * r->period, &suggested, NULL, &tick, 1);
        }
    }
    counts[0] = w->steps;
    counts[1] = w->rejected;
    counts[2] = w->events;
    free(w);
    return status;
}
