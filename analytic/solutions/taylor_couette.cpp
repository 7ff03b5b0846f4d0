// Plane flow between two rotating cylinders, r1 <= r <= r2, set going at t = 0, or steady.
//
// The azimuthal velocity obeys ∂u/∂t = ν (u″ + u′/r − u/r²). Steady: u = Ar + B/r. From rest, by the
// functions
//   Z(αr) = J1(αr) Y1(αr1) − Y1(αr) J1(αr1),  Z(αr2) = 0,  with ∫ r Z² dr = (2/π²α²)(R² − 1), R =
//   J1(αr1)/J1(αr2): u = Ar + B/r − Σ π (R u2 − u1)/(R² − 1) Z(αr) e^{−να²t},
// the coefficients by Green's formula with r Z′ = −2/π at r1 and −2R/π at r2. Terms are summed while
// e^{−να²t} is above 1e-17 of 1. Below τ = νt/(r2 − r1)² = 1e-5, where that would take 600 of them and the
// walls do not yet feel each other, the solution about either single cylinder is expanded for small times:
// its Laplace transform, (u1/s) K1(qr)/K1(qr1) with q = √(s/ν), has for large q the asymptotic expansion
//   (u1/s) √(r1/r) e^{−q(r−r1)} Σ b_k q^{−k},   which inverts to   u1 √(r1/r) Σ b_k (4νt)^{k/2} i^k
//   erfc((r−r1)/√(4νt)),
// and likewise I1(qr)/I1(qr2) with (−1)^k b_k. Seven terms leave an error of (√(νt)/r1)^7 of the wall's
// velocity, 1e-11 at the narrowest inner cylinder that is accepted.
//
// The pressure balances the centripetal acceleration, ∂p/∂r = ρu²/r, and is zero on the inner cylinder. The
// fields hold between the cylinders and a few hundredths of the gap beyond.
#include "sphvv/analytic/layer_diffusion.hpp"
#include "sphvv/analytic/solutions.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>
#include <gsl/gsl_sf_bessel.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace sphvv::analytic::solutions {

const Solution& taylor_couette();

namespace {

using std::numbers::pi;

constexpr double small_time = 1e-5;
constexpr int short_time_terms = 7;
constexpr double negligible_exponent = 40; // e^-40 = 4e-18

struct Constants {
    double r1;      ///< m
    double r2;      ///< m
    double u1;      ///< m/s, of the inner cylinder's surface
    double u2;      ///< m/s, of the outer cylinder's surface
    double A;       ///< 1/s
    double B;       ///< m2/s
    double rho;     ///< kg/m3
    double nu;      ///< m2/s
    double settled; ///< share of the steady flow in the start
};

/// nu = u1 (r2 − r1)/Re; A = (u2 r2 − u1 r1)/(r2² − r1²), B = r1 r2 (u1 r2 − u2 r1)/(r2² − r1²).
Constants constants(const Values& given) {
    const Values values = resolve(taylor_couette(), given);
    const double r1 = values.at("inner_radius");
    const double r2 = r1 / values.at("radius_ratio");
    const double u1 = values.at("speed");
    const double u2 = values.at("rotation_ratio") * u1 / r1 * r2;
    const double squares = (r2 - r1) * (r2 + r1);
    return {r1,
            r2,
            u1,
            u2,
            (u2 * r2 - u1 * r1) / squares,
            r1 * r2 * (u1 * r2 - u2 * r1) / squares,
            values.at("density"),
            u1 * (r2 - r1) / values.at("re"),
            values.at("steady_start")};
}

/// An eigenfunction, for r1 = 1 and the outer radius rho.
struct Mode {
    double alpha;
    double ratio; ///< R = J1(alpha)/J1(alpha rho)
    double J1;    ///< of alpha
    double Y1;    ///< of alpha

    double operator()(double r) const {
        return gsl_sf_bessel_J1(alpha * r) * Y1 - gsl_sf_bessel_Y1(alpha * r) * J1;
    }
};

double cross_product(double alpha, double outer) {
    return gsl_sf_bessel_J1(alpha * outer) * gsl_sf_bessel_Y1(alpha) -
           gsl_sf_bessel_Y1(alpha * outer) * gsl_sf_bessel_J1(alpha);
}

/// Root of cross_product between low and high.
double root_between(double low, double high, double outer) {
    gsl_function function{
        [](double alpha, void* ratio) { return cross_product(alpha, *static_cast<const double*>(ratio)); },
        &outer};
    const std::unique_ptr<gsl_root_fsolver, decltype(&gsl_root_fsolver_free)> solver{
        gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free};
    gsl_root_fsolver_set(solver.get(), &function, low, high);
    for (int iteration = 0; iteration < 100; ++iteration) {
        gsl_root_fsolver_iterate(solver.get());
        const double a = gsl_root_fsolver_x_lower(solver.get());
        const double b = gsl_root_fsolver_x_upper(solver.get());
        if (gsl_root_test_interval(a, b, 0, 4e-16) == GSL_SUCCESS) {
            break;
        }
    }
    return gsl_root_fsolver_root(solver.get());
}

/// The first modes for an outer radius, as many as live at tau = small_time. The n-th root lies between (n −
/// ½) and (n + ½) pi/(outer − 1): the n-th is near n pi/(outer − 1), above it by 3/(8 n pi) (outer − 1)/outer
/// or less (McMahon).
std::vector<Mode> modes_for(double outer) {
    const double spacing = pi / (outer - 1);
    const int count = static_cast<int>(std::ceil(std::sqrt(negligible_exponent / small_time) / pi)) + 1;
    std::vector<Mode> modes;
    modes.reserve(count);
    for (int n = 1; n <= count; ++n) {
        const double alpha = root_between((n - 0.5) * spacing, (n + 0.5) * spacing, outer);
        const double J1 = gsl_sf_bessel_J1(alpha);
        const double Y1 = gsl_sf_bessel_Y1(alpha);
        const double J2 = gsl_sf_bessel_J1(alpha * outer);
        const double Y2 = gsl_sf_bessel_Y1(alpha * outer);
        // J1/J2 and Y1/Y2 are equal at a root; the larger pair gives it without cancellation.
        modes.push_back({alpha, std::abs(J2) > std::abs(Y2) ? J1 / J2 : Y1 / Y2, J1, Y1});
    }
    return modes;
}

/// Coefficients b_k of K1(qr)/K1(qr1) = √(r1/r) e^{−q(r−r1)} Σ b_k q^{−k}: the quotient of the asymptotic
/// series Σ a_k (qr)^{−k} of K1 with a_k = Π_{j<=k} (4 − (2j − 1)²)/(8j). That of I1 has the signs (−1)^k.
std::array<double, short_time_terms> quotient(double r, double wall) {
    std::array<double, short_time_terms> a{};
    std::array<double, short_time_terms> b{};
    for (int k = 0; k < short_time_terms; ++k) {
        a[k] = k == 0 ? 1 : a[k - 1] * (4 - (2 * k - 1) * (2 * k - 1)) / (8. * k);
        b[k] = a[k] / std::pow(r, k);
        for (int j = 1; j <= k; ++j) {
            b[k] -= a[j] / std::pow(wall, j) * b[k - j];
        }
    }
    return b;
}

/// Velocity at r over that of a single cylinder of radius `wall` that turns since t = 0, fluid outside it or
/// inside.
double beside_cylinder(double r, double wall, double viscous_length) {
    const double distance = std::abs(r - wall);
    const auto b = quotient(r, wall);
    double sum = 0;
    for (int k = 0; k < short_time_terms; ++k) {
        const double sign = wall > r && k % 2 == 1 ? -1 : 1;
        sum += sign * b[k] * std::pow(2 * viscous_length, k) *
               layer::repeated_erfc(k, distance / (2 * viscous_length));
    }
    return std::sqrt(wall / r) * sum;
}

class Flow {
public:
    explicit Flow(const Constants& constants)
        : c(constants),
          modes(std::make_shared<const std::vector<Mode>>(modes_for(constants.r2 / constants.r1))) {}

    /// Azimuthal velocity (m/s).
    double velocity(double r, double t) const {
        const double steady = c.A * r + c.B / r;
        if (c.settled == 1) {
            return steady;
        }
        const double gap = c.r2 - c.r1;
        if (t <= 0) {
            return c.settled * steady;
        }
        if (c.nu * t < small_time * gap * gap) {
            const double l = std::sqrt(c.nu * t);
            const double started = c.u1 * beside_cylinder(r, c.r1, l) + c.u2 * beside_cylinder(r, c.r2, l);
            return c.settled * steady + (1 - c.settled) * started;
        }
        double decaying = 0;
        for (const Mode& mode : *modes) {
            const double exponent = mode.alpha * mode.alpha * c.nu * t / (c.r1 * c.r1);
            if (exponent > negligible_exponent) {
                break;
            }
            decaying += pi * (mode.ratio * c.u2 - c.u1) / (mode.ratio * mode.ratio - 1) * mode(r / c.r1) *
                        std::exp(-exponent);
        }
        return steady - (1 - c.settled) * decaying;
    }

    /// Torque per length on the inner cylinder, 2π r1² ρν (u′ − u/r) at r1 (N m/m), by the series; from t =
    /// small_time.
    double torque(double t) const {
        double shear = -2 * c.B / (c.r1 * c.r1); // u' − u/r of Ar + B/r
        for (const Mode& mode : *modes) {
            const double exponent = mode.alpha * mode.alpha * c.nu * t / (c.r1 * c.r1);
            if (exponent > negligible_exponent) {
                break;
            }
            shear += (1 - c.settled) * 2 * (mode.ratio * c.u2 - c.u1) / (mode.ratio * mode.ratio - 1) / c.r1 *
                     std::exp(-exponent);
        }
        return 2 * pi * c.r1 * c.r1 * c.rho * c.nu * shear;
    }

    const Constants c;

private:
    std::shared_ptr<const std::vector<Mode>> modes;
};

/// Sum of Chebyshev polynomials on an interval.
class Chebyshev {
public:
    template <class Function>
    Chebyshev(double low_end, double high_end, const Function& function) : low(low_end), high(high_end) {
        std::array<double, degree> values{};
        for (int i = 0; i < degree; ++i) {
            values[i] = function((low + high) / 2 + (high - low) / 2 * std::cos(pi * (i + 0.5) / degree));
        }
        for (int k = 0; k < degree; ++k) {
            for (int i = 0; i < degree; ++i) {
                coefficients[k] +=
                    (k == 0 ? 1. : 2.) / degree * values[i] * std::cos(pi * k * (i + 0.5) / degree);
            }
        }
    }
    /// By Clenshaw's recursion.
    double operator()(double x) const {
        const double s = (2 * x - low - high) / (high - low);
        double b1 = 0;
        double b2 = 0;
        for (int k = degree - 1; k > 0; --k) {
            b2 = std::exchange(b1, 2 * s * b1 - b2 + coefficients[k]);
        }
        return s * b1 - b2 + coefficients[0];
    }
    /// The integral from the low end: ∫ T_k = [T_{k+1}/(k + 1) − T_{k−1}/(k − 1)]/2.
    Chebyshev integral() const {
        Chebyshev result(*this);
        double at_low = 0;
        for (int k = 1; k < degree; ++k) {
            const double above = k + 1 < degree ? coefficients[k + 1] : 0;
            result.coefficients[k] =
                (high - low) / 2 * ((k == 1 ? 2. : 1.) * coefficients[k - 1] - above) / (2 * k);
            at_low += (k % 2 == 0 ? 1 : -1) * result.coefficients[k];
        }
        result.coefficients[0] = -at_low;
        return result;
    }

private:
    static constexpr int degree = 48; // e^{−x²} over 0 < x < 6 to 5e-16
    double low;
    double high;
    std::array<double, degree> coefficients{};
};

/// Velocity and pressure over the radius at one time. A sum of Bessel functions at every particle would cost
/// more than the step it is compared with. Panels: the layers of thickness 12 √(νt) at the walls and the rest
/// while the layers are apart, else thirds.
class Profile {
public:
    Profile(const Flow& flow, double t) : time(t) {
        const double gap = flow.c.r2 - flow.c.r1;
        const double layer = std::min(12 * std::sqrt(flow.c.nu * t), gap / 3);
        const double width = layer > 0 ? layer : gap / 3;
        const std::array ends{flow.c.r1, flow.c.r1 + width, flow.c.r2 - width, flow.c.r2};
        double pressure = 0;
        for (std::size_t i = 1; i < ends.size(); ++i) {
            const Chebyshev u(ends[i - 1], ends[i], [&](double r) { return flow.velocity(r, t); });
            const Chebyshev rise = Chebyshev(ends[i - 1], ends[i], [&](double r) {
                                       return flow.c.rho * u(r) * u(r) / r;
                                   }).integral();
            panels.push_back({ends[i], pressure, u, rise});
            pressure += rise(ends[i]);
            squares += Chebyshev(ends[i - 1], ends[i], [&](double r) {
                           return u(r) * u(r) * r;
                       }).integral()(ends[i]);
        }
    }
    double velocity(double r) const { return panel(r).velocity(r); }
    double pressure(double r) const { return panel(r).start + panel(r).rise(r); }

    const double time;
    double squares = 0; ///< ∫ u² r dr (m4/s2)

private:
    struct Panel {
        double end;
        double start; ///< Pa, at the panel's low end
        Chebyshev velocity;
        Chebyshev rise;
    };
    const Panel& panel(double r) const {
        return r < panels[0].end ? panels[0] : r < panels[1].end ? panels[1] : panels[2];
    }
    std::vector<Panel> panels;
};

/// The profile at the time last asked for; a profile depends on the time alone, so which thread made it is no
/// matter.
class LatestProfile {
public:
    explicit LatestProfile(const Constants& constants) : flow(constants) {}
    std::shared_ptr<const Profile> at(double t) {
        std::shared_ptr<const Profile> found = latest.load();
        if (!found || found->time != t) {
            found = std::make_shared<const Profile>(flow, t);
            latest.store(found);
        }
        return found;
    }

private:
    Flow flow;
    std::atomic<std::shared_ptr<const Profile>> latest;
};

Domain domain(const Values& given) {
    const double r2 = constants(given).r2;
    return {{-r2, -r2, 0}, {r2, r2, 0}, {false, false, false}};
}

/// No larger speed than those of the walls (maximum principle).
Medium medium(const Values& given) {
    const Constants c = constants(given);
    return {c.rho, c.nu, std::max(std::abs(c.u1), std::abs(c.u2))};
}

Evaluator bind(const Values& given) {
    return [latest = std::make_shared<LatestProfile>(constants(given))](const Vector& x, double t) {
        const double r = std::hypot(x[0], x[1]);
        const std::shared_ptr<const Profile> profile = latest->at(t);
        const double u = profile->velocity(r);
        return State{{-u * x[1] / r, u * x[0] / r, 0}, profile->pressure(r)};
    };
}

/// 2/(r2² − r1²) ∫ (u²/2) r dr.
double kinetic_energy(const Values& given, double t) {
    const Constants c = constants(given);
    return Profile(Flow(c), t).squares / ((c.r2 - c.r1) * (c.r2 + c.r1));
}

std::vector<Boundary> cylinders(const Values& given) {
    const Constants c = constants(given);
    const auto turning = [](double u, double radius) {
        return [omega = u / radius](const Vector& x, double) {
            return Vector{-omega * x[1], omega * x[0], 0};
        };
    };
    return {{"inner cylinder", BoundaryKind::no_slip,
             [r1 = c.r1](const Vector& x) { return std::hypot(x[0], x[1]) - r1; }, turning(c.u1, c.r1)},
            {"outer cylinder", BoundaryKind::no_slip,
             [r2 = c.r2](const Vector& x) { return r2 - std::hypot(x[0], x[1]); }, turning(c.u2, c.r2)}};
}

Scalar azimuthal_velocity(const Values& given) {
    return [flow = Flow(constants(given))](const Vector& x, double t) {
        return flow.velocity(std::hypot(x[0], x[1]), t);
    };
}

Scalar inner_torque(const Values& given) {
    return [flow = Flow(constants(given))](const Vector&, double t) { return flow.torque(t); };
}

} // namespace

const Solution& taylor_couette() {
    static const Solution solution{
        .name = "taylor_couette",
        .summary = "Plane flow between rotating cylinders, set going at t = 0, or steady",
        .formula =
            "u_θ = Ar + B/r − (1 − s) Σ π(Ru2 − u1)/(R² − 1) Z(αr) e^{−να²t}, A = (u2r2 − u1r1)/(r2² − r1²), "
            "B = r1r2(u1r2 − u2r1)/(r2² − r1²), Z = J1(αr)Y1(αr1) − Y1(αr)J1(αr1), Z(αr2) = 0, R = "
            "J1(αr1)/J1(αr2), "
            "p = ρ∫u_θ²/r dr from r1, ν = u1(r2 − r1)/Re, s the share of the steady flow in the start. "
            "νt/(r2 − r1)² < 1e-5: expansion for small times. Error 1e-11 of the walls' velocity",
        .source = "H. Schlichting, Boundary-Layer Theory (7th ed. 1979) ch. V; G. N. Watson, A Treatise on "
                  "the Theory "
                  "of Bessel Functions (2nd ed. 1944) ch. VII, XV; H. S. Carslaw & J. C. Jaeger, "
                  "Conduction of Heat "
                  "in Solids (2nd ed. 1959) ch. XIII (method)",
        .dimension = 2,
        .parameters =
            {
                {"re", "1", "Reynolds number u1(r2 − r1)/ν", 100, 1e-3, 1e8},
                {"speed", "m/s", "u1, of the inner cylinder's surface", 1, 1e-6, 1e6},
                {"inner_radius", "m", "r1", 1, 1e-6, 1e6},
                {"radius_ratio", "1", "r1/r2", 0.5, 0.1, 0.95},
                {"rotation_ratio", "1", "angular velocity of the outer over that of the inner cylinder", 0,
                 -2, 2},
                {"density", "kg/m3", "ρ", 1000, 1e-6, 1e6},
                {"steady_start", "1", "s, share of the steady flow in the start; 1: steady at all times", 0,
                 0, 1},
            },
        .domain = domain,
        .medium = medium,
        .bind = bind,
        .kinetic_energy = kinetic_energy,
        .boundaries = cylinders,
        .quantities =
            {
                {"azimuthal_velocity", "m/s", "u_θ at x and t", azimuthal_velocity},
                {"inner_torque", "N m/m",
                 "viscous torque on the inner cylinder per length at t, νt > 1e-5 (r2 − r1)²", inner_torque},
            },
    };
    return solution;
}

} // namespace sphvv::analytic::solutions
