"""The survey once more, by other means: attitudes from a triad of directions, derivatives by complex steps, all unknowns of the
multi-station estimate and of the alignment in one dense system without scaling, the rotation by Cayley's map, covariances of error tests by a dense inverse, the path by vectors, the covariance of its
positions by complex steps of the whole path.
Prints readings and results, one record a line; tests/survey/independent_test.cpp compares. Standard library only."""
import cmath
import math

G0, B0, DIP = 9.8123, 50.4e-6, 1.2345
SIGMA_REF = (1.5e-3, 130e-9, math.radians(0.2))
RANDOM_REF = (0.0, 60e-9, math.radians(0.08))
NOISE_G, NOISE_B = 1e-3, 20e-9
TOOL = [0.004] * 3 + [5e-4] * 3 + [70e-9, 70e-9, math.hypot(70e-9, 220e-9)] + [0.0016] * 3
ASKED = (6, 7, 8)
STATIONS = 18
STEP = 1e-30


class Lehmer:
    def __init__(self, seed):
        self.state = seed

    def uniform(self):
        self.state = 48271 * self.state % 2147483647
        return self.state / 2147483647

    def normal(self):
        return sum(self.uniform() for _ in range(12)) - 6.0


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = cmath.sqrt(dot(a, a))
    return tuple(x / length for x in a)


def pairs(v):
    """(y, x) of each of the four angles, complex."""
    down = unit(v[:3])
    east = unit(cross(down, v[3:]))
    north = cross(east, down)
    return ((cmath.sqrt(north[2] ** 2 + east[2] ** 2), down[2]), (-v[0], -v[1]), (v[3], v[4]), (east[2], north[2]))


def totals(v):
    """Gravity, field, and the pair of the dip."""
    g, b = v[:3], v[3:]
    c = cross(g, b)
    return cmath.sqrt(dot(g, g)), cmath.sqrt(dot(b, b)), (dot(g, b), cmath.sqrt(dot(c, c)))


def angle(pair):
    return math.atan2(pair[0].real, pair[1].real)


def angle_slope(pair):
    """d atan2(y, x) of a complex step."""
    y, x = pair
    return (x.real * y.imag - y.real * x.imag) / (x.real ** 2 + y.real ** 2) / STEP


def stepped(v, k, scale=1.0):
    return tuple(complex(x, STEP * scale if i == k else 0.0) for i, x in enumerate(v))


def jacobian_of_angles(v):
    columns = [[angle_slope(p) for p in pairs(stepped(v, k))] for k in range(6)]
    return [[columns[k][row] for k in range(6)] for row in range(4)]


def totals_slopes(v):
    """Of a vector that carries a complex step."""
    g, b, pair = totals(v)
    return [g.imag / STEP, b.imag / STEP, angle_slope(pair)]


def jacobian_of_totals(v):
    columns = [totals_slopes(stepped(v, k)) for k in range(6)]
    return [[columns[k][row] for k in range(6)] for row in range(3)]


def sandwich(j, diagonal):
    return [[sum(a[k] * diagonal[k] * b[k] for k in range(len(diagonal))) for b in j] for a in j]


def inverse(a):
    """Gauss and Jordan with pivots, rows and columns scaled by the diagonal."""
    n = len(a)
    s = [1.0 / math.sqrt(abs(a[i][i])) for i in range(n)]
    m = [[a[i][j] * s[i] * s[j] for j in range(n)] + [float(i == j) for j in range(n)] for i in range(n)]
    for c in range(n):
        p = max(range(c, n), key=lambda r: abs(m[r][c]))
        m[c], m[p] = m[p], m[c]
        pivot = m[c][c]
        m[c] = [x / pivot for x in m[c]]
        for r in range(n):
            if r != c and m[r][c] != 0.0:
                factor = m[r][c]
                m[r] = [x - factor * y for x, y in zip(m[r], m[c])]
    return [[m[i][n + j] * s[i] * s[j] for j in range(n)] for i in range(n)]


def times(m, v):
    return [dot(row, v) for row in m]


def station(inc, azi, tool_face):
    """The three axes of the tool in north, east, down, from three plain turns."""
    def turned(v, axis, by):
        c, s = math.cos(by), math.sin(by)
        i, j = (axis + 1) % 3, (axis + 2) % 3
        out = list(v)
        out[i], out[j] = c * v[i] - s * v[j], s * v[i] + c * v[j]
        return out
    axes = []
    for axis in range(3):
        v = [float(k == axis) for k in range(3)]
        v = turned(v, 2, tool_face - math.pi / 2)  # y to the high side at toolface 0
        v = turned(v, 1, inc)
        axes.append(turned(v, 2, azi))
    field = (B0 * math.cos(DIP), 0.0, B0 * math.sin(DIP))
    return [G0 * a[2] for a in axes] + [dot(a, field) for a in axes]


def readings():
    draw = Lehmer(20260331)
    errors = [0.003, -0.002, 0.004, 3e-4, -2e-4, 4e-4, 150e-9, -90e-9, 700e-9, 0.001, -0.0012, 0.0015]
    out = []
    for k in range(STATIONS):
        true = station(math.radians(4.0 + 5.0 * k), math.radians(20.0 + 7.0 * k), 1.3 * k)
        out.append([(1.0 + errors[3 + i if i < 3 else 6 + i]) * x + errors[i if i < 3 else 3 + i]
                    + (NOISE_G if i < 3 else NOISE_B) * draw.normal() for i, x in enumerate(true)])
    return out


VARIANCE = [NOISE_G ** 2] * 3 + [NOISE_B ** 2] * 3


def random_of(v):
    c = sandwich(jacobian_of_totals(v), VARIANCE)
    return [[c[i][j] + (RANDOM_REF[i] ** 2 if i == j else 0.0) for j in range(3)] for i in range(3)]


def corrected(v, x):
    return tuple((v[i] - x[i if i < 3 else 3 + i]) / (1.0 + x[3 + i if i < 3 else 6 + i]) for i in range(6))


def residual(v, x):
    g, b, pair = totals(corrected([complex(c) for c in v], x))
    return [g.real - G0 - x[12].real, b.real - B0 - x[13].real, angle(pair) - DIP - x[14].real]


def estimate(stations):
    prior = [0.0 if k in ASKED else 1.0 / s ** 2 for k, s in enumerate(TOOL + list(SIGMA_REF))]
    weights = [inverse(random_of(v)) for v in stations]
    x = [0.0] * 15
    for _ in range(30):
        normal = [[prior[i] if i == j else 0.0 for j in range(15)] for i in range(15)]
        right = [-prior[i] * x[i] for i in range(15)]
        for v, w in zip(stations, weights):
            columns = []
            for k in range(12):
                bent = [complex(c, STEP if i == k else 0.0) for i, c in enumerate(x)]
                columns.append(totals_slopes(corrected([complex(c) for c in v], bent)))
            columns += [[-float(i == k) for i in range(3)] for k in range(3)]
            wr = times(w, residual(v, x))
            wa = [times(w, c) for c in columns]
            for i in range(15):
                right[i] -= dot(columns[i], wr)
                for j in range(15):
                    normal[i][j] += dot(columns[i], wa[j])
        covariance = inverse(normal)
        step = times(covariance, right)
        x = [a + b for a, b in zip(x, step)]
    chi = sum(dot(r, times(w, r)) for v, w in zip(stations, weights) for r in [residual(v, x)])
    chi += sum(p * c * c for p, c in zip(prior, x))
    return x, covariance, chi


def turned(v, w):
    """v turned by 2 atan(|w| / 2) about w (Cayley): to first order, all that a complex step sees, by w."""
    half = tuple(c / 2.0 for c in w)
    inner = tuple(a + b for a, b in zip(v, cross(half, v)))
    scale = 2.0 / (1.0 + dot(half, half))
    return tuple(a + scale * c for a, c in zip(v, cross(half, inner)))


def alignment(stations, dip_known):
    """Rotation (three turns one after another), terms, references; covariance of a further small turn and the rest."""
    prior = [0.0] * 3 + [1.0 / s ** 2 for s in TOOL + list(SIGMA_REF)]
    if not dip_known:
        prior[17] = 0.0
    weights = [inverse(random_of(v)) for v in stations]
    turns, x = [], [0.0] * 15

    def totals_at(v, bent, w):
        c = corrected([complex(r) for r in v], bent)
        field = c[3:]
        for t in turns:
            field = turned(field, t)
        return totals(c[:3] + turned(field, w))

    for _ in range(12):
        normal = [[prior[i] if i == j else 0.0 for j in range(18)] for i in range(18)]
        right = [-p * c for p, c in zip(prior, [0.0] * 3 + x)]
        chi = sum(p * c * c for p, c in zip(prior[3:], x))
        for v, weight in zip(stations, weights):
            columns = []
            for k in range(15):
                at = totals_at(v, [complex(c, STEP if k == 3 + i else 0.0) for i, c in enumerate(x)],
                               [complex(0.0, STEP if k == i else 0.0) for i in range(3)])
                columns.append([at[0].imag / STEP, at[1].imag / STEP, angle_slope(at[2])])
            columns += [[-float(i == k) for i in range(3)] for k in range(3)]
            g, b, pair = totals_at(v, x, (0.0, 0.0, 0.0))
            r = [g.real - G0 - x[12], b.real - B0 - x[13], angle(pair) - DIP - x[14]]
            wr = times(weight, r)
            wa = [times(weight, c) for c in columns]
            chi += dot(r, wr)
            for i in range(18):
                right[i] -= dot(columns[i], wr)
                for j in range(18):
                    normal[i][j] += dot(columns[i], wa[j])
        covariance = inverse(normal)
        step = times(covariance, right)
        turns.append(step[:3])
        x = [a + b for a, b in zip(x, step[3:])]
    rotation = [[float(i == k) for i in range(3)] for k in range(3)]
    for t in turns:
        rotation = [turned(column, t) for column in rotation]
    return rotation, turns, x, covariance, chi


def error_test(stations, kind):
    n = len(stations)
    shared, r = [], []
    for v in stations:
        j = jacobian_of_totals(v)[kind]
        shared.append([j[i] * TOOL[i] for i in range(3)] + [j[i] * v[i] * TOOL[3 + i] for i in range(3)]
                      + [j[3 + i] * TOOL[6 + i] for i in range(3)] + [j[3 + i] * v[3 + i] * TOOL[9 + i] for i in range(3)]
                      + [SIGMA_REF[kind]])
        g, b, pair = totals([complex(c) for c in v])
        r.append((g.real - G0, b.real - B0, angle(pair) - DIP)[kind])
    c = [[dot(shared[i], shared[j]) + (random_of(stations[i])[kind][kind] if i == j else 0.0) for j in range(n)] for i in range(n)]
    inv = inverse(c)
    weighted = times(inv, r)
    ones = sum(map(sum, inv))
    return [dot(r, weighted), sum(weighted) / ones, 1.0 / math.sqrt(ones)] + [weighted[i] / math.sqrt(inv[i][i]) for i in range(n)]


def path(stations):
    """Arcs laid out in their own plane by centre, radius and normal."""
    at, out, before = [0.0, 0.0, 0.0], [], None
    for k, v in enumerate(stations):
        p = pairs([complex(c) for c in v])
        inc, azi = angle(p[0]), angle(p[3])
        t = (math.sin(inc) * math.cos(azi), math.sin(inc) * math.sin(azi), math.cos(inc))
        bend = 0.0
        if before is not None:
            n = cross(before, t)
            sine = math.sqrt(dot(n, n))
            bend = math.atan2(sine, dot(before, t))
            radius = 30.0 / bend
            inward = tuple(c / sine for c in cross(n, before))
            at = [a + radius * (math.sin(bend) * b + (1.0 - math.cos(bend)) * i) for a, b, i in zip(at, before, inward)]
        out.append(at + [bend])
        before = t
    return out


COMMON = (math.radians(0.4), math.radians(0.1), 0.35, 5e-4)  # declination, sag, depth, depth in proportion


def path_of_aligned(stations, turns, x, unknowns, common, noise):
    """North, east, depth of every station, complex: terms and rotation changed by `unknowns`, common errors by `common`, and a
    component of one station by `noise` (station, component, step)."""
    at, out, before = (0.0, 0.0, 0.0), [], None
    for k, v in enumerate(stations):
        c = corrected([complex(r) for r in v], [a + u for a, u in zip(x, unknowns[3:])])
        field = c[3:]
        for t in turns:
            field = turned(field, t)
        v = list(c[:3] + turned(field, unknowns[:3]))
        if noise[0] == k:
            v[noise[1]] += noise[2]
        down = unit(v[:3])
        east = unit(cross(down, v[3:]))
        north = cross(east, down)
        sine = cmath.sqrt(north[2] ** 2 + east[2] ** 2)
        grown = 1.0 + common[1] * down[2]
        n, e = north[2] * grown, east[2] * grown
        t = (n - common[0] * e, e + common[0] * n, down[2] - common[1] * sine ** 2)
        if before is not None:
            depths = [30.0 * i + (common[2] + 30.0 * i * common[3] if i > 0 else 0.0) for i in (k - 1, k)]
            normal = cross(before, t)
            bent = cmath.sqrt(dot(normal, normal))
            bend = cmath.atan(bent / dot(before, t))
            inward = tuple(i / bent for i in cross(normal, before))
            radius = (depths[1] - depths[0]) / bend
            at = tuple(a + radius * (bent * b + (1.0 - dot(before, t)) * i) for a, b, i in zip(at, before, inward))
        out.append(at)
        before = t
    return out


def position_covariance(stations, turns, x, covariance):
    """Row-major 3 x 3 of each station."""
    def slopes(unknown=-1, common=-1, noise=(-1, 0)):
        step = complex(0.0, STEP)
        found = path_of_aligned(stations, turns, x, [step if k == unknown else 0.0 for k in range(15)],
                                [step if k == common else 0.0 for k in range(4)], (*noise, step))
        return [[complex(c).imag / STEP for c in point] for point in found]
    n = len(stations)
    carried = [slopes(unknown=k) for k in range(15)]
    alone = [(slopes(common=k), s ** 2) for k, s in enumerate(COMMON)]
    alone += [(slopes(noise=(k, c)), VARIANCE[c]) for k in range(n) for c in range(6)]
    out = []
    for k in range(n):
        out.append([sum(carried[a][k][i] * covariance[a][b] * carried[b][k][j] for a in range(15) for b in range(15))
                    + sum(s[k][i] * variance * s[k][j] for s, variance in alone) for i in range(3) for j in range(3)])
    return out


def show(name, *numbers):
    print(name, *(repr(float(x)) for x in numbers))


def main():
    stations = readings()
    for v in stations:
        show("reading", *v)
    for v in stations:
        p = pairs([complex(c) for c in v])
        c = sandwich(jacobian_of_angles(v), VARIANCE)
        show("attitude", *(angle(q) for q in p), *(x for row in c for x in row))
        g, b, pair = totals([complex(c) for c in v])
        t = sandwich(jacobian_of_totals(v), VARIANCE)
        show("totals", g.real, b.real, angle(pair), *(t[k][k] for k in range(3)))
    x, covariance, chi = estimate(stations)
    show("estimate", *x)
    show("covariance", *(covariance[i][j] for i in range(12) for j in range(12)))
    show("chi", chi)
    apart = [v[:3] + list(turned(v[3:], (0.012, -0.007, 0.009))) for v in stations]
    for v in apart:
        show("apart", *v)
    for dip_known in (True, False):
        rotation, turns, x, covariance, chi = alignment(apart, dip_known)
        show("rotation", *(rotation[k][i] for i in range(3) for k in range(3)))
        show("aligned", *x, chi)
        show("alignment", *(covariance[i][j] for i in range(15) for j in range(15)))
        show("dip", covariance[17][17])
        for row in position_covariance(apart, turns, x, covariance):
            show("position" if dip_known else "position_unknown_dip", *row)
    for kind in range(3):
        show("test", *error_test(stations, kind))
    for point in path(stations):
        show("path", *point)


if __name__ == "__main__":
    main()
