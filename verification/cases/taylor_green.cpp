#include "sphvv/verification/cases.hpp"
#include "sphvv/verification/claims.hpp"

#include <array>
#include <cmath>

namespace sphvv::verification::cases {
namespace {

constexpr double any = 1e300;

const std::string first_order_source =
    "Xu 2009 §4.3.2: about 1, criterion >= 0.9; forward Euler with dt proportional to h";

const Expected zeroth_order{std::nullopt, 0.5,
                            "Quinlan, Basa & Lastiwka 2006; verification rules §4: order -1 of the operator"};

// The weakly compressible scheme and ISPH_DFDI let pairs of particles come close and carry on: where they are
// compared, the arrangement is not among the conditions of survival.
const std::string dfdi = "isph_dfdi:minimum_spacing=0";
const std::string wcsph_any_spacing = "wcsph:minimum_spacing=0";

const std::string squeezed =
    "particles that follow the flow are squeezed at its saddle points by exp[-(Re/4pi)(1-e^(kappa t))]: at "
    "Re = 100 to dx/4 by t = 0.24 (at Re = 10 never below 0.45 dx), when the next particle in the stretched "
    "direction is 4 dx away, out of the support";

Expectation ends_early(const char* scheme, const char* source, const std::string& text) {
    return {.scheme = scheme,
            .field = "",
            .where = {{"re", 100, 1e4}, {"end_time", 0.5, any}, {"minimum_spacing", 0.25, 1}},
            .order = {std::nullopt, std::nullopt, source},
            .text = text,
            .ends_early = true};
}

std::vector<Expectation> expectations() {
    return {
        {.scheme = "isph_dfs",
         .field = "velocity",
         // Below Re = 50 the viscous limit rules and dt is proportional to h^2: another ladder.
         .where = {{"re", 50, 1e4}},
         .order = {0.9, 2.0, first_order_source},
         .text =
             "the forward Euler velocity step leaves an error of O(dt), and dt = 0.2 h/U (0.2 h^2/nu once h "
             "< nu/U: the last rung at Re = 100, n = 160); operators and kernel add O(h^2), so a coarse "
             "ladder may show up to 2"},
        {.scheme = "isph_mls",
         .field = "velocity",
         .where = {{"re", 50, 1e4}, {"operators", 0, 0, "quadratic"}, {"integrator", 0, 0, "heun2"}},
         .order = {1.7, std::nullopt,
                   "derived: Heun's method with dt proportional to h, quadratic moving least squares"},
         .text = "gradients O(h^2), Laplacian O(h^2) on even particles, Heun O(dt^2), divergence O(h^4): "
                 "second order; the error in the pressure gradient is nearly a gradient, which the "
                 "divergence condition takes out, so at large Re a coarse ladder falls faster than h^2"},
        {.scheme = "isph_mls",
         .field = "pressure",
         .where = {{"re", 50, 1e4}, {"operators", 0, 0, "quadratic"}, {"integrator", 0, 0, "heun2"}},
         .order = {1.0, 2.5, "derived: quadratic moving least squares (operator laplacian_mls_quadratic)"},
         .text = "tr(grad u grad u) is wrong by O(h^2), Lap p by O(h^2) on even and by O(h) on disordered "
                 "particles: the order comes down from 2 towards 1 as disorder grows"},
        {.scheme = "isph_mls",
         .field = "velocity",
         .where = {{"re", 50, 1e4}, {"integrator", 0, 0, "euler"}},
         .order = {0.9, 2.0, "derived: forward Euler with dt proportional to h"},
         .text = "the time marching of ISPH_DFS with other operators: first order, from above"},
        ends_early("isph_df", "Xu 2009 §4.1: DF unstable at Re = 100 and 1000", squeezed),
        ends_early("isph_lee", "Xu 2009 §2.2: operators at the old positions give the same results as DF",
                   squeezed),
        ends_early("isph_asai", "derived, as for ISPH_DF: a squeeze that keeps areas is no density error",
                   squeezed),
        ends_early("isph_di", "derived, as for ISPH_DF: a squeeze that keeps areas is no density error",
                   squeezed),
        ends_early("isph_dfdi", "derived, as for ISPH_DF; Xu 2009 §2.1.4: close pairs repel each other less",
                   squeezed),
        {.scheme = "wcsph",
         .field = "",
         .where = {{"re", 100, 1e4}, {"arrangement", 0, 0, "jittered"}},
         .order = zeroth_order,
         .text = "as from the lattice: the error of the symmetric gradient does not fall with h",
         .waiver = "from a jittered start single pairs pass below 0.25 dx (0.22 dx; with either integrator, "
                   "h/dx 1.3 and 1.6, background pressure 0 and 0.5) in some seeds of most rungs, where |W'| "
                   "falls again towards r = 0 and hardly repels (Xu sheet §1.2); with minimum_spacing=0.05 "
                   "the runs go on to errors of 47 and 34 % at 20^2 and 40^2"},
        {.scheme = "wcsph",
         .field = "velocity",
         .where = {{"re", 100, 1e4}},
         .order = zeroth_order,
         .text = "the symmetric pressure gradient on disordered particles at fixed h/dx has an error that "
                 "does not fall with h, so the flow's error levels off; below 0.5 it is nearer to that than "
                 "to the first order that Lee 2008 reports for the cavity"},
    };
}

using Runs = std::span<const RunRecord>;
using MaybeFinding = std::optional<Claim::Finding>;

/// The runs of these schemes at one rung, or nothing unless all are there.
template <class... Names>
auto all_of(Runs runs, int n, const Names&... names) {
    const std::array found{find_run(runs, names, n)...};
    const bool complete = std::ranges::find(found, nullptr) == found.end();
    return complete ? std::optional(found) : std::nullopt;
}

std::string errors_of(const RunRecord& run) {
    return fate(run, "velocity " + percent(l2_error(run, "velocity")) + ", pressure " +
                         percent(l2_error(run, "pressure")));
}

MaybeFinding all_stable_at_re_10(Runs runs) {
    const auto of = all_of(runs, 40, "isph_df", "isph_di", dfdi, "isph_dfs");
    if (!of) {
        return std::nullopt;
    }
    const auto& [df, di, both, dfs] = *of;
    const auto stable = [](const RunRecord* run) { return run->survived; };
    const auto better = [&](const RunRecord* run) {
        return std::abs(run->maximum_speed_error) >= std::abs(of->back()->maximum_speed_error);
    };
    const auto text = [](const RunRecord* run) { return number(100 * run->maximum_speed_error, "%+.2f %%"); };
    return Claim::Finding{"u_max error at 40^2: DF " + text(df) + ", DI " + text(di) + ", DFDI " +
                              text(both) + ", DFS " + text(dfs),
                          std::ranges::all_of(*of, stable) && std::ranges::all_of(*of, better)};
}

MaybeFinding df_unstable(Runs runs) {
    const auto of = all_of(runs, 40, "isph_df", "isph_dfs");
    if (!of) {
        return std::nullopt;
    }
    const auto& [df, dfs] = *of;
    return Claim::Finding{"at 40^2 DF " + fate(*df, "survives") + " (spacing " +
                              number(df->minimum_spacing, "%.2f dx") + "), DFS " + fate(*dfs, "survives") +
                              " (" + number(dfs->minimum_spacing, "%.2f dx") + ")",
                          !df->survived && dfs->survived};
}

/// The profiles of the thesis are plots, in which an error of 5 % is hardly seen.
constexpr double accurate = 0.05;

MaybeFinding dfdi_and_dfs_accurate(Runs runs) {
    const auto of = all_of(runs, 40, dfdi, "isph_dfs");
    if (!of) {
        return std::nullopt;
    }
    const auto& [both, dfs] = *of;
    return Claim::Finding{"L2 at 40^2: DFDI " + errors_of(*both) + " (spacing " +
                              number(both->minimum_spacing, "%.2f dx") + "), DFS " + errors_of(*dfs),
                          l2_error(*both, "velocity") < accurate && l2_error(*dfs, "velocity") < accurate};
}

MaybeFinding di_stable(Runs runs) {
    const RunRecord* di = find_run(runs, "isph_di", 40);
    if (di == nullptr) {
        return std::nullopt;
    }
    return Claim::Finding{"at 40^2 " + fate(*di, errors_of(*di)) +
                              (di->survived ? "" : ": " + di->diagnosis.substr(0, di->diagnosis.find(','))),
                          di->survived};
}

MaybeFinding noise_of_the_pressure(Runs runs) {
    const auto of = all_of(runs, 40, "isph_di", dfdi, "isph_dfs");
    if (!of) {
        return std::nullopt;
    }
    const auto& [di, both, dfs] = *of;
    const bool di_worst = !di->survived || l2_error(*di, "pressure") > 2 * l2_error(*dfs, "pressure");
    return Claim::Finding{"pressure at 40^2: DI " + fate(*di, percent(l2_error(*di, "pressure"))) +
                              ", DFDI " + fate(*both, percent(l2_error(*both, "pressure"))) + ", DFS " +
                              fate(*dfs, percent(l2_error(*dfs, "pressure"))),
                          di_worst && l2_error(*dfs, "pressure") < l2_error(*both, "pressure")};
}

MaybeFinding u_max_converges(Runs runs) {
    const RunRecord* coarse = find_run(runs, "isph_dfs", 40);
    const RunRecord* fine = find_run(runs, "isph_dfs", 80);
    if (coarse == nullptr || fine == nullptr) {
        return std::nullopt;
    }
    return Claim::Finding{"u_max error 40^2 " + number(100 * coarse->maximum_speed_error, "%+.2f %%") +
                              ", 80^2 " + number(100 * fine->maximum_speed_error, "%+.2f %%"),
                          coarse->maximum_speed_error < 0 &&
                              std::abs(fine->maximum_speed_error) < std::abs(coarse->maximum_speed_error)};
}

/// The run time of one scheme over another's at 40^2, which must lie in [low, high].
Claim cpu_ratio(std::string id, const std::string& above, const std::string& below, std::string published,
                double low, double high, std::vector<Condition> where) {
    return {.id = std::move(id),
            .text = "run time of " + above.substr(0, above.find(':')) + " over " + below + " at 40^2",
            .published = std::move(published),
            .source = "Xu 2009 §4.1, table of CPU times",
            .where = std::move(where),
            .measure = [=](Runs runs) -> MaybeFinding {
                const auto of = all_of(runs, 40, above, below);
                if (!of || !(*of)[0]->survived || !(*of)[1]->survived) {
                    return std::nullopt;
                }
                const double ratio = (*of)[0]->seconds / (*of)[1]->seconds;
                return Claim::Finding{number(ratio, "%.2f") + " (work " +
                                          number(work_of(*(*of)[0]) / work_of(*(*of)[1]), "%.2f") + ")",
                                      ratio >= low && ratio <= high};
            }};
}

MaybeFinding first_order_with_both_laplacians(Runs runs) {
    const std::string ls = "isph_dfs:laplacian=schwaiger";
    const auto order_lm = fitted_order(runs, "isph_dfs", "velocity", 20, 4);
    const auto order_ls = fitted_order(runs, ls, "velocity", 20, 4);
    if (!order_lm || !order_ls) {
        return std::nullopt;
    }
    const auto finest = [&](const std::string& label) {
        double error = 0;
        for (const RunRecord& run : runs) {
            error = run.scheme == label ? l2_error(run, "velocity") : error;
        }
        return error;
    };
    return Claim::Finding{"orders " + number(*order_lm, "%.2f") + " (LM) and " + number(*order_ls, "%.2f") +
                              " (LS); finest rung " + percent(finest("isph_dfs")) + " and " +
                              percent(finest(ls)),
                          *order_lm >= 0.9 && *order_ls >= 0.9 && finest(ls) < finest("isph_dfs")};
}

/// The largest error in time of ISPH_DFS at rung n, which must be at most what was published.
Claim published_error(std::string id, int n, double bound, std::vector<Condition> where) {
    return {.id = std::move(id),
            .text = "largest L2 error in time of ISPH_DFS, LM, at " + std::to_string(n) + "^2 (to t = 2)",
            .published = percent(bound),
            .source = "Xu 2009 §4.3.2",
            .where = std::move(where),
            .measure = [=](Runs runs) -> MaybeFinding {
                const RunRecord* run = find_run(runs, "isph_dfs", n);
                if (run == nullptr) {
                    return std::nullopt;
                }
                const double error = largest_l2_error(*run);
                return Claim::Finding{percent(error), run->survived && error <= bound};
            }};
}

MaybeFinding corrections_of_the_shift(Runs runs) {
    const auto of =
        all_of(runs, 160, "isph_dfs:shift_correction=none", "isph_dfs", "isph_dfs:shift_correction=second");
    if (!of) {
        return std::nullopt;
    }
    const auto& [none, first, second] = *of;
    const double e0 = largest_l2_error(*none);
    const double e1 = largest_l2_error(*first);
    const double e2 = largest_l2_error(*second);
    return Claim::Finding{"largest L2 in time: none " + percent(e0) + ", first " + percent(e1) + ", second " +
                              percent(e2),
                          none->survived && e1 < e0 && e2 < e0 && std::abs(e1 - e2) < 0.1 * (e0 - e1)};
}

MaybeFinding which_mattered(Runs runs) {
    const auto of =
        all_of(runs, 80, "isph_mls", "isph_mls:integrator=euler", "isph_mls:operators=renormalised",
               "isph_mls:integrator=euler:operators=renormalised");
    if (!of) {
        return std::nullopt;
    }
    std::string text = "L2 at 80^2 and order:";
    std::vector<double> orders;
    for (const RunRecord* run : *of) {
        const auto order = fitted_order(runs, run->scheme, "velocity", 40, 4);
        orders.push_back(order.value_or(0));
        text += (orders.size() == 1   ? " both second order "
                 : orders.size() == 2 ? "; only the operators "
                 : orders.size() == 3 ? "; only the time marching "
                                      : "; neither ");
        text += percent(l2_error(*run, "velocity")) + ", " + number(orders.back(), "%.2f");
    }
    return Claim::Finding{text, orders[0] >= 1.7 && orders[1] < 1.5 && orders[2] < 1.5 && orders[3] < 1.5};
}

/// The goals of the second-order scheme on the rungs 40 to 160.
MaybeFinding orders_of_isph_mls(Runs runs) {
    const auto velocity = fitted_order(runs, "isph_mls", "velocity", 40);
    const auto pressure = fitted_order(runs, "isph_mls", "pressure", 40);
    if (!velocity || !pressure) {
        return std::nullopt;
    }
    return Claim::Finding{"velocity " + number(*velocity, "%.2f") + ", pressure " + number(*pressure, "%.2f"),
                          *velocity >= 1.8 && *pressure >= 1.5};
}

Claim less_work(double factor, std::vector<Condition> where) {
    return {.id = "GOAL, work",
            .text =
                "isph_mls reaches the velocity error of isph_dfs at 160^2 with less work (pair evaluations "
                "and matrix entries)",
            .published = "goal: at least " + number(factor, "%g") + " times less",
            .source = "this project",
            .where = std::move(where),
            .measure = [=](Runs runs) -> MaybeFinding {
                const RunRecord* dfs = find_run(runs, "isph_dfs", 160);
                if (dfs == nullptr || !dfs->survived) {
                    return std::nullopt;
                }
                const auto work = work_at_error(runs, "isph_mls", l2_error(*dfs, "velocity"));
                if (!work) {
                    return std::nullopt;
                }
                return Claim::Finding{number(work_of(*dfs) / *work, "%.0f") + " times less, at an error of " +
                                          percent(l2_error(*dfs, "velocity")),
                                      work_of(*dfs) / *work >= factor};
            }};
}

MaybeFinding cheaper_than_wcsph(Runs runs) {
    const auto of = all_of(runs, 40, wcsph_any_spacing, "isph_dfs");
    if (!of) {
        return std::nullopt;
    }
    const auto& [wcsph, dfs] = *of;
    const double ratio = wcsph->seconds / dfs->seconds;
    return Claim::Finding{"ISPH_DFS at 40^2 takes 1/" + number(ratio, "%.2f") + " of the time of WCSPH; L2 " +
                              errors_of(*dfs) + " against " + errors_of(*wcsph),
                          ratio >= 2 && dfs->survived &&
                              !(l2_error(*wcsph, "velocity") <= l2_error(*dfs, "velocity"))};
}

MaybeFinding smooth_pressure(Runs runs) {
    const auto of = all_of(runs, 40, wcsph_any_spacing, "isph_dfs");
    if (!of) {
        return std::nullopt;
    }
    const auto& [wcsph, dfs] = *of;
    return Claim::Finding{"pressure at 40^2: ISPH_DFS " + percent(l2_error(*dfs, "pressure")) + ", WCSPH " +
                              fate(*wcsph, percent(l2_error(*wcsph, "pressure"))),
                          !wcsph->survived || l2_error(*wcsph, "pressure") > 2 * l2_error(*dfs, "pressure")};
}

MaybeFinding momentum_of_symmetric_gradients(Runs runs) {
    const auto of = all_of(runs, 40, wcsph_any_spacing, "isph_lee");
    if (!of) {
        return std::nullopt;
    }
    const auto& [wcsph, lee] = *of;
    constexpr double round_off = 1e-12;
    return Claim::Finding{"drift / (M U): WCSPH " + number(wcsph->budget.momentum_drift, "%.1e") +
                              ", isph_lee " + number(lee->budget.momentum_drift, "%.1e"),
                          wcsph->budget.momentum_drift < round_off && lee->budget.momentum_drift < round_off};
}

MaybeFinding relaxation_keeps_the_density(Runs runs) {
    const auto of = all_of(runs, 40, "isph_asai", "isph_asai:relaxation=0");
    if (!of) {
        return std::nullopt;
    }
    const auto& [relaxed, plain] = *of;
    return Claim::Finding{
        "at 40^2 alpha = 0.1 " + fate(*relaxed, errors_of(*relaxed)) + ", alpha = 0 " +
            fate(*plain, errors_of(*plain)),
        relaxed->time > plain->time ||
            (relaxed->survived && l2_error(*relaxed, "velocity") < l2_error(*plain, "velocity"))};
}

/// Energy that pairs of forms gain or lose without viscosity: continuity and pressure force.
MaybeFinding energy_of(Runs runs, const std::vector<std::string>& conserve,
                       const std::vector<std::string>& do_not) {
    std::string text = "energy drift";
    double largest_kept = 0;
    double smallest_lost = any;
    for (const std::string& label : conserve) {
        const RunRecord* run = find_run(runs, label, 20);
        if (run == nullptr) {
            return std::nullopt;
        }
        largest_kept = std::max(largest_kept, std::abs(run->budget.energy_drift));
        text += " " + number(run->budget.energy_drift, "%.1e");
    }
    text += do_not.empty() ? "" : "; against";
    for (const std::string& label : do_not) {
        const RunRecord* run = find_run(runs, label, 20);
        if (run == nullptr) {
            return std::nullopt;
        }
        smallest_lost = std::min(smallest_lost, std::abs(run->budget.energy_drift));
        text += " " + number(run->budget.energy_drift, "%.1e");
    }
    return Claim::Finding{text, 3 * largest_kept < smallest_lost};
}

const std::string sigma_2 = "wcsph";
const std::string sigma_1 = "wcsph:continuity=sigma_1:pressure_force=sigma_1";
const std::string coherent = "wcsph:continuity=renormalised:pressure_force=renormalised_coherent";
const std::string issa_pair = "wcsph:continuity=sigma_2:pressure_force=sigma_1";
const std::string non_coherent = "wcsph:continuity=renormalised:pressure_force=renormalised";
const std::string taylor = "wcsph:continuity=renormalised:pressure_force=taylor";

std::vector<Claim> claims() {
    const std::vector<Condition> re_10{{"re", 10, 10}};
    const std::vector<Condition> re_100{{"re", 100, 100}};
    const std::vector<Condition> re_1000{{"re", 1000, 1000}};
    const std::vector<Condition> re_100_1000{{"re", 100, 1000}};
    const std::vector<Condition> to_2_at_100{{"re", 100, 100}, {"end_time", 2, 2}};
    const std::vector<Condition> to_2_at_1000{{"re", 1000, 1000}, {"end_time", 2, 2}};
    const std::vector<Condition> without_viscosity{{"re", 1e7, any}};
    const auto claim = [](const char* id, const char* text, const char* published, const char* source,
                          const std::vector<Condition>& where,
                          auto measure) { return Claim{id, text, published, source, where, measure}; };
    return {
        claim("XU-TG, Re 10", "all four projections are stable and accurate, and ISPH_DFS has the best u_max",
              "figure", "Xu 2009 §4.1", re_10, all_stable_at_re_10),
        claim("XU-TG, Re 100 and 1000",
              "ISPH_DF is unstable where ISPH_DFS with the same parameters carries on", "figure",
              "Xu 2009 §4.1", re_100_1000, df_unstable),
        claim("XU-TG, Re 100", "ISPH_DFDI and ISPH_DFS are accurate (L2 of the velocity below 5 %)", "figure",
              "Xu 2009 §4.1", re_100, dfdi_and_dfs_accurate),
        claim("XU-TG, Re 100 and 1000",
              "ISPH_DI is stable, but under-predicts (Re 100) or is noisy (Re 1000)", "figure",
              "Xu 2009 §4.1", re_100_1000, di_stable),
        claim("XU-TG, Re 1000", "pressure: ISPH_DI very noisy, ISPH_DFDI a little, ISPH_DFS smooth", "figure",
              "Xu 2009 §4.1", re_1000, noise_of_the_pressure),
        claim("XU-TG, Re 1000", "ISPH_DFS is slightly low in u_max at 40^2 and converges at 80^2", "figure",
              "Xu 2009 §4.1", re_1000, u_max_converges),
        cpu_ratio("XU-CPU", "isph_dfs", "isph_df", "1.10 (1213 s / 1103 s); check <= 1.15", 0, 1.15, re_10),
        cpu_ratio("XU-CPU", dfdi, "isph_dfs", "4.2, 4.1 at Re 100, 1000; check >= 3", 3, any, re_100_1000),
        cpu_ratio("XU-CPU", dfdi, "isph_dfs", "3.3 at Re 10", 3, any, re_10),
        claim("XU-TGCONV", "first order with both Laplacians, LS slightly more accurate",
              "about 1; check >= 0.9", "Xu 2009 §4.3.2", to_2_at_1000, first_order_with_both_laplacians),
        published_error("XU-TGCONV, Re 100", 200, 0.00045, to_2_at_100),
        published_error("XU-TGCONV, Re 1000", 240, 0.025, to_2_at_1000),
        claim("XU-TGCORR",
              "at 160^2 first- and second-order correction of the shift do alike, both better than none",
              "figure", "Xu 2009 §4.3.3 (Re not stated)", re_100_1000, corrections_of_the_shift),
        claim("Open question of Xu 2009 §5",
              "operators or time marching hold ISPH_DFS to first order: which?", "both suspected",
              "Xu 2009 §5", re_100_1000, which_mattered),
        claim("GOAL, order", "isph_mls, fitted on the rungs 40 to 160",
              "goal: velocity >= 1.8, pressure >= 1.5", "this project", re_100_1000, orders_of_isph_mls),
        less_work(15, re_100),
        less_work(50, re_1000),
        claim("LEE, cost", "ISPH is 2 to 20 times cheaper than WCSPH at better accuracy",
              "9.2, 23.5 and 3.7 times (cavity, square, wet bed)", "Lee 2008 §1.4", re_100_1000,
              cheaper_than_wcsph),
        claim("LEE, pressure", "the pressure of ISPH is smooth, that of WCSPH very noisy", "figure",
              "Lee 2008 §1.4 (cavity)", re_100_1000, smooth_pressure),
        claim("LEE, momentum", "the antisymmetric pressure gradient conserves momentum", "stated",
              "Lee 2008 §1.3", {}, momentum_of_symmetric_gradients),
        claim("ASAI, volume", "relaxed density invariance keeps the density where alpha = 0 loses it",
              "figure", "Asai 2012 (dam break)", re_100_1000, relaxation_keeps_the_density),
        claim("ISSA, pairing", "the rate S2 and the force P1 belong together, and mixing S2 with P2 is poor",
              "stated", "Issa 2005 §2", without_viscosity,
              [](Runs runs) { return energy_of(runs, {issa_pair}, {sigma_2}); }),
        claim("OGER, pairing",
              "energy is conserved where rate and force have the same sigma, and by the coherent "
              "renormalised pair; not by the non-coherent one nor by Taylor-SPH",
              "stated", "Oger 2007", without_viscosity,
              [](Runs runs) {
                  return energy_of(runs, {sigma_2, sigma_1, coherent}, {issa_pair, non_coherent, taylor});
              }),
    };
}

std::vector<Study> studies() {
    const std::vector<std::string> projections_and_more{
        wcsph_any_spacing,        "isph_df", "isph_di", dfdi, "isph_dfs", "isph_lee", "isph_asai",
        "isph_asai:relaxation=0", "isph_mls"};
    const std::vector<std::string> pairs{sigma_2, sigma_1, coherent, issa_pair, non_coherent, taylor};
    const std::vector<std::string> marching{"isph_mls", "isph_mls:integrator=euler",
                                            "isph_mls:operators=renormalised",
                                            "isph_mls:integrator=euler:operators=renormalised"};
    return {
        {.name = "taylor_green/lattice",
         .tier = Tier::quick,
         .schemes = {"wcsph", "isph_df", "isph_dfs", "isph_mls"},
         .settings = {{"re", "100"}},
         .ladder = {20, 40, 80, 160},
         .cost = "70 s"},
        {.name = "taylor_green/jittered",
         .tier = Tier::quick,
         .schemes = {"isph_dfs"},
         .settings = {{"re", "100"}, {"arrangement", "jittered"}},
         .ladder = {20, 28, 40, 56, 80},
         .cost = "30 s"},
        {.name = "taylor_green/re10",
         .tier = Tier::quick,
         .schemes = projections_and_more,
         .settings = {{"re", "10"}, {"end_time", "0.1"}},
         .ladder = {40},
         .cost = "3 s",
         .picture_at = 40},
        {.name = "taylor_green/re100",
         .tier = Tier::quick,
         .schemes = projections_and_more,
         .settings = {{"re", "100"}},
         .ladder = {40},
         .cost = "8 s",
         .picture_at = 40},
        {.name = "taylor_green/re1000",
         .tier = Tier::quick,
         .schemes = projections_and_more,
         .settings = {{"re", "1000"}},
         .ladder = {40},
         .cost = "8 s",
         .picture_at = 40},
        {.name = "taylor_green/time",
         .tier = Tier::quick,
         .schemes = {"wcsph", "wcsph:integrator=predictor_corrector", "isph_df", "isph_mls"},
         .settings = {{"re", "100"}, {"end_time", "0.08"}, {"pressure_tolerance", "1e-12"}},
         .ladder = {12},
         .cost = "10 s",
         .time_steps = {0.008, 0.004, 0.002, 0.001, 0.0005}},
        {.name = "taylor_green/energy",
         .tier = Tier::quick,
         .schemes = pairs,
         // A hundredth of the acoustic limit: what drifts is not the integrator's.
         .settings = {{"re", "1e8"},
                      {"end_time", "0.1"},
                      {"arrangement", "jittered"},
                      {"integrator", "predictor_corrector"},
                      {"time_step", "2e-4"}},
         .ladder = {20},
         .cost = "15 s"},
        {.name = "taylor_green/order_re100",
         .tier = Tier::nightly,
         .schemes = {"isph_dfs", "isph_mls"},
         .settings = {{"re", "100"}},
         .ladder = {20, 28, 40, 56, 80, 112, 160},
         .cost = "2 min"},
        {.name = "taylor_green/order_re1000",
         .tier = Tier::nightly,
         .schemes = {"isph_dfs", "isph_mls"},
         .settings = {{"re", "1000"}},
         .ladder = {20, 28, 40, 56, 80, 112, 160},
         .cost = "2 min"},
        {.name = "taylor_green/marching_re100",
         .tier = Tier::nightly,
         .schemes = marching,
         .settings = {{"re", "100"}},
         .ladder = {40, 56, 80, 112, 160},
         .cost = "3 min"},
        {.name = "taylor_green/marching_re1000",
         .tier = Tier::nightly,
         .schemes = marching,
         .settings = {{"re", "1000"}},
         .ladder = {40, 56, 80, 112, 160},
         .cost = "3 min"},
        {.name = "taylor_green/fine",
         .tier = Tier::nightly,
         .schemes = {"wcsph", "isph_df", "isph_dfs"},
         .settings = {{"re", "100"}},
         .ladder = {20, 40, 80, 160, 240},
         .cost = "4 min"},
        {.name = "taylor_green/re1000_order",
         .tier = Tier::nightly,
         .schemes = {"isph_dfs", "isph_dfs:laplacian=schwaiger"},
         .settings = {{"re", "1000"}, {"end_time", "2"}},
         .ladder = {20, 40, 80, 160},
         .cost = "2 min"},
        {.name = "taylor_green/re1000_80",
         .tier = Tier::nightly,
         .schemes = {"isph_dfs", "isph_mls"},
         .settings = {{"re", "1000"}},
         .ladder = {40, 80},
         .cost = "10 s"},
        {.name = "taylor_green/shift_correction",
         .tier = Tier::nightly,
         .schemes = {"isph_dfs:shift_correction=none", "isph_dfs", "isph_dfs:shift_correction=second"},
         .settings = {{"re", "1000"}},
         .ladder = {40, 80, 160},
         .cost = "1 min"},
        {.name = "taylor_green/forms",
         .tier = Tier::nightly,
         .schemes = {sigma_2, sigma_1, coherent, issa_pair, non_coherent, taylor,
                     "wcsph:continuity=renormalised:pressure_force=hybrid_taylor",
                     "wcsph:integrator=predictor_corrector", "wcsph:integrator=verlet",
                     "wcsph:viscosity=monaghan_cleary"},
         .settings = {{"re", "100"}, {"end_time", "0.1"}},
         .ladder = {20, 40, 80},
         .cost = "1 min",
         .picture_at = 40},
        {.name = "taylor_green/fine_jittered",
         .tier = Tier::nightly,
         .schemes = {"wcsph", "isph_dfs", "isph_mls"},
         .settings = {{"re", "100"}, {"arrangement", "jittered"}},
         .ladder = {20, 40, 80, 160},
         .cost = "8 min"},
        {.name = "taylor_green/fine_settled",
         .tier = Tier::nightly,
         .schemes = {wcsph_any_spacing, "isph_dfs", "isph_mls"},
         .settings = {{"re", "100"}, {"arrangement", "settled"}},
         .ladder = {20, 40, 80, 160},
         .cost = "8 min"},
        {.name = "taylor_green/xu_re100",
         .tier = Tier::full,
         .schemes = {"isph_dfs", "isph_dfs:laplacian=schwaiger", "isph_mls"},
         .settings = {{"re", "100"}, {"end_time", "2"}},
         .ladder = {40, 80, 120, 160, 200},
         .cost = "10 min"},
        {.name = "taylor_green/xu_re1000",
         .tier = Tier::full,
         .schemes = {"isph_dfs", "isph_dfs:laplacian=schwaiger", "isph_mls"},
         .settings = {{"re", "1000"}, {"end_time", "2"}},
         .ladder = {40, 80, 120, 160, 200, 240},
         .cost = "15 min"},
    };
}

} // namespace

const Case& taylor_green() {
    static const Case flow{
        .name = "taylor_green",
        .summary = "decaying Taylor-Green vortices in a doubly periodic square",
        .equations = "incompressible Navier-Stokes in 2-D",
        .source = "Xu 2009 §4.1 (XU-TG); Taylor & Green 1937",
        .solution = "taylor_green",
        .reference_length = "length",
        .leading_key = "re",
        .end_time = 1,
        .expectations = expectations(),
        .claims = claims(),
        .studies = studies(),
    };
    return flow;
}

} // namespace sphvv::verification::cases
