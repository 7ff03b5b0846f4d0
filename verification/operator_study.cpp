#include "sphvv/verification/operator_study.hpp"

#include "sphvv/verification/claims.hpp"
#include "sphvv/verification/operator_fields.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace sphvv::verification {
namespace {

using solver::Approximates;
using solver::Operator;

constexpr double joint_power = 0.5; ///< h ~ dx^s
constexpr double half_width = 0.25; ///< of an order band: half of theory's smallest step, see expected_order
constexpr int seeds_of_random = 5;  ///< rules of evidence §3

double smoothing_length(const OperatorLadder& ladder, int n) {
    const double coarsest_dx = 1.0 / ladder.n.front();
    const double dx = 1.0 / n;
    switch (ladder.path) {
    case Path::fixed_ratio:
        return ladder.coarsest_h_over_dx * dx;
    case Path::fixed_h:
        return ladder.coarsest_h_over_dx * coarsest_dx;
    case Path::joint:
        break;
    }
    return ladder.coarsest_h_over_dx * coarsest_dx * std::pow(dx / coarsest_dx, joint_power);
}

/// What one operator gave on one scene.
struct Judged {
    std::optional<Norms> norms;
    std::size_t particles = 0;
    int undetermined = 0;
};

/// Norms of values - limit * exact, component by component, over the judged particles that the neighbours
/// determine.
template <int Dim>
Judged hold_against_exact(const OperatorScene<Dim>& scene, const PlaneWave<Dim>& wave, const Operator& op,
                          const std::vector<double>& limit) {
    const std::vector<std::vector<double>> found = scene.apply(op);
    std::vector<std::vector<double>> value(found.size());
    std::vector<std::vector<double>> reference(found.size());
    std::vector<double> volume;
    Judged judged;
    for (const int i : scene.set.judged) {
        if (std::ranges::any_of(found, [&](const auto& column) { return std::isnan(column[i]); })) {
            ++judged.undetermined;
            continue;
        }
        const std::vector<double> exact = wave.exact(op.approximates, scene.point(i));
        for (std::size_t c = 0; c < found.size(); ++c) {
            value[c].push_back(found[c][i]);
            reference[c].push_back((limit.empty() ? 1 : limit[c]) * exact[c]);
        }
        volume.push_back(scene.set.volume[i]);
    }
    judged.particles = volume.size();
    if (!volume.empty()) {
        const std::vector<std::span<const double>> values(value.begin(), value.end());
        const std::vector<std::span<const double>> references(reference.begin(), reference.end());
        judged.norms = vector_norms(values, references, volume);
    }
    return judged;
}

/// What the operator makes of the exact result as dx -> 0 at this h: a factor for each component (div grad u
/// and grad div u are not smoothed alike), and the factor that fits all of them best.
struct Limit {
    std::vector<double> component;
    double overall = 1;
};

/// On a lattice the operator takes a plane wave to multiples of the exact result's components, and on one
/// this fine its sums are integrals.
template <int Dim>
Limit limit_of(const Operator& op, const solver::Kernel& kernel, double h) {
    // A block of few judged particles affords a larger h/dx, but has no room for the reach of two sums.
    const bool block = Dim == 2 && !op.chained;
    const double h_over_dx = Dim == 3 ? 3 : block ? 10 : 5;
    const int n = static_cast<int>(std::ceil(h_over_dx / h));
    OperatorScene<Dim> scene(block ? particle_block<Dim>(Arrangement::square, n, kernel.support * h, 0)
                                   : particle_set<Dim>(Arrangement::square, n, 0, 0),
                             kernel, h);
    const PlaneWave<Dim> wave(scene.set.box);
    wave.fill(scene);
    std::fill(scene.density.begin(), scene.density.end(), 1.0);
    const std::vector<std::vector<double>> found = scene.apply(op);
    std::vector<double> product(found.size(), 0);
    std::vector<double> square(found.size(), 0);
    for (const int i : scene.set.judged) {
        const std::vector<double> exact = wave.exact(op.approximates, scene.point(i));
        for (std::size_t c = 0; c < exact.size(); ++c) {
            product[c] += found[c][i] * exact[c];
            square[c] += exact[c] * exact[c];
        }
    }
    Limit limit;
    for (std::size_t c = 0; c < found.size(); ++c) {
        limit.component.push_back(product[c] / square[c]);
    }
    limit.overall = std::accumulate(product.begin(), product.end(), 0.0) /
                    std::accumulate(square.begin(), square.end(), 0.0);
    return limit;
}

double geometric_mean(const std::vector<Norms>& norms, double Norms::*member) {
    double total = 0;
    for (const Norms& each : norms) {
        total += std::log(each.*member);
    }
    return std::exp(total / static_cast<double>(norms.size()));
}

OperatorSample sample_of(const std::vector<Judged>& seeds, int n, double h, double pairs) {
    OperatorSample sample{n, h, 1.0 / n, 0, {}, 0, static_cast<int>(seeds.size()), 0, pairs};
    std::vector<Norms> norms;
    for (const Judged& judged : seeds) {
        sample.particles += judged.particles;
        sample.undetermined += judged.undetermined;
        if (judged.norms) {
            norms.push_back(*judged.norms);
        }
    }
    sample.particles /= seeds.size();
    if (norms.size() == seeds.size()) {
        Norms mean = norms.front();
        if (norms.size() > 1) {
            for (double Norms::*member :
                 {&Norms::l1, &Norms::l2, &Norms::linf, &Norms::l1_abs, &Norms::l2_abs, &Norms::linf_abs}) {
                mean.*member = geometric_mean(norms, member);
            }
        }
        sample.norms = mean;
        const auto [low, high] = std::minmax_element(
            norms.begin(), norms.end(), [](const Norms& a, const Norms& b) { return a.l2 < b.l2; });
        sample.l2_spread = low->l2 > 0 ? high->l2 / low->l2 - 1 : 0;
    }
    return sample;
}

std::vector<double> pairwise(const std::vector<OperatorSample>& samples, double Norms::*member) {
    std::vector<double> orders(samples.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 1; k < samples.size(); ++k) {
        if (samples[k - 1].norms && samples[k].norms) {
            orders[k] = std::log((*samples[k - 1].norms).*member / (*samples[k].norms).*member) /
                        std::log(samples[k - 1].dx / samples[k].dx);
        }
    }
    return orders;
}

void judge_study(OperatorStudy& study, const std::vector<Rung>& rungs) {
    study.order_l1 = pairwise(study.samples, &Norms::l1);
    study.order_l2 = pairwise(study.samples, &Norms::l2);
    study.order_linf = pairwise(study.samples, &Norms::linf);
    const auto lost = std::find_if(study.samples.begin(), study.samples.end(),
                                   [](const OperatorSample& sample) { return !sample.norms; });
    if (lost != study.samples.end()) {
        study.verdict = "FAIL";
        study.reason = "no particle of n = " + std::to_string(lost->n) + " determines the operator";
        return;
    }
    const double undetermined =
        std::accumulate(study.samples.begin(), study.samples.end(), 0.0,
                        [](double sum, const OperatorSample& sample) { return sum + sample.undetermined; });
    if (undetermined > 0) {
        study.verdict = "FAIL";
        study.reason = "the neighbours of some particles do not determine the operator";
        return;
    }
    if (!study.expected) {
        study.verdict = "NONE";
        study.reason = "no order follows from the declaration: observed only";
        return;
    }
    const Judgement judgement = judge(rungs, *study.expected);
    study.verdict = to_string(judgement.verdict);
    study.reason = judgement.reason;
    study.fit = judgement.fit;
}

/// In three dimensions a filled box that resolves a wave as the two-dimensional ladders do would take
/// millions of particles, so a block of it is judged. What is judged keeps two supports from an end:
/// operators of two sweeps read their neighbours' results.
template <int Dim>
ParticleSet<Dim> particles_of(const OperatorLadder& ladder, int n, double support, std::uint64_t seed) {
    const bool block = Dim == 3 && is_random(ladder.arrangement) && ladder.path != Path::fixed_h;
    return block ? particle_block<Dim>(ladder.arrangement, n, 2 * support, seed)
                 : particle_set<Dim>(ladder.arrangement, n, 2 * support, seed);
}

template <int Dim>
std::vector<OperatorStudy> run_ladder(std::span<const Operator* const> operators,
                                      const OperatorLadder& ladder, const solver::Kernel& kernel,
                                      const std::function<void(int n)>& tell) {
    std::vector<OperatorStudy> studies;
    std::vector<std::vector<Rung>> rungs(operators.size());
    std::vector<Limit> limits(operators.size());
    for (std::size_t o = 0; o < operators.size(); ++o) {
        studies.push_back({operators[o],
                           ladder,
                           std::string(kernel.name),
                           expected_order(*operators[o], ladder),
                           {},
                           {},
                           {},
                           {},
                           {},
                           {},
                           {}});
        if (ladder.path == Path::fixed_h) {
            limits[o] = limit_of<Dim>(*operators[o], kernel, smoothing_length(ladder, ladder.n.front()));
        }
    }
    for (const int n : ladder.n) {
        const double h = smoothing_length(ladder, n);
        std::vector<std::vector<Judged>> judged(operators.size());
        double pairs = 0;
        for (int seed = 1; seed <= ladder.seeds; ++seed) {
            OperatorScene<Dim> scene(
                particles_of<Dim>(ladder, n, kernel.support * h, static_cast<std::uint64_t>(seed)), kernel,
                h);
            const PlaneWave<Dim> wave(scene.set.box);
            wave.fill(scene);
            if (ladder.path == Path::fixed_h) {
                std::fill(scene.density.begin(), scene.density.end(), 1.0); // as in limit_of
            }
            pairs += static_cast<double>(scene.neighbours.pairs()) / ladder.seeds;
            for (std::size_t o = 0; o < operators.size(); ++o) {
                judged[o].push_back(hold_against_exact<Dim>(scene, wave, *operators[o], limits[o].component));
            }
        }
        for (std::size_t o = 0; o < operators.size(); ++o) {
            studies[o].samples.push_back(sample_of(judged[o], n, h, operators[o]->sweeps * pairs));
            Rung rung{1.0 / n, {}};
            for (const Judged& each : judged[o]) {
                rung.errors.push_back(each.norms ? each.norms->l2 : std::numeric_limits<double>::quiet_NaN());
            }
            rungs[o].push_back(rung);
        }
        tell(n);
    }
    const double k_squared = Dim * std::pow(2 * std::numbers::pi, 2);
    const double h = smoothing_length(ladder, ladder.n.front());
    for (std::size_t o = 0; o < operators.size(); ++o) {
        judge_study(studies[o], rungs[o]);
        // A Gaussian of variance h^2, more than a kernel's, leaves exp(-(kh)^2/2) of a wave, and the square
        // of that where two operators follow each other. Whoever is farther off, or adds to the wave by more
        // than a lattice sum is off at the h/dx of limit_of, converges to something else.
        if (ladder.path == Path::fixed_h &&
            !(limits[o].overall >= std::exp(-k_squared * h * h) && limits[o].overall <= 1.01)) {
            studies[o].verdict = "FAIL";
            studies[o].reason =
                "the limit at this h is " + number(limits[o].overall, "%.4g") + " times the exact result";
        }
    }
    return studies;
}

Expected around(double low, double high, const std::string& source) {
    return {low - half_width, high + half_width, source};
}

Expected at_least(double low, const std::string& source) {
    return {low - half_width, std::nullopt, source};
}

} // namespace

std::string_view to_string(Path path) {
    switch (path) {
    case Path::fixed_ratio:
        return "h/dx fixed";
    case Path::fixed_h:
        return "h fixed";
    case Path::joint:
        break;
    }
    return "h ~ sqrt(dx)";
}

std::optional<Expected> expected_order(const Operator& op, const OperatorLadder& ladder) {
    if (op.approximates == Approximates::nothing) {
        return std::nullopt;
    }
    const bool without_field = solver::field_components(op.approximates, 2) == 0;
    const solver::OrderModel& model = op.order;
    const double d = ladder.dimension;
    const double irregular = 1 - model.noise_power;
    const std::string source(model.source);
    const bool tiles_or_rings =
        ladder.arrangement == Arrangement::settled || ladder.arrangement == Arrangement::polar;
    const double smoothing = joint_power * model.smoothing;
    // Where independent positions enter two sums, one of which reads the other, the product of their noises
    // still shows.
    const bool squared_noise = op.chained && ladder.arrangement == Arrangement::random;
    if (ladder.path == Path::fixed_h) {
        if (tiles_or_rings || (model.lattice_floor && ladder.dimension == 3)) {
            return std::nullopt; // no law of their noise; no limit that is known well enough
        }
        const double order = ladder.arrangement == Arrangement::random ? d / 2 : 1 + d / 2;
        return around(order, squared_noise ? 2 * order : order, "quadrature noise at fixed h: " + source);
    }
    if (ladder.path == Path::joint) {
        if (tiles_or_rings || is_truncated(ladder.arrangement) ||
            (is_lattice(ladder.arrangement) && without_field)) {
            return std::nullopt; // no law of their noise; h/dx, on which an edge's constant and a lattice sum
                                 // depend, changes
        }
        if (is_lattice(ladder.arrangement)) {
            return model.lattice_floor
                       ? at_least(smoothing, "smoothing, and a lattice sum that h/dx makes better: " + source)
                       : around(smoothing, smoothing, "smoothing error on a lattice: " + source);
        }
        const bool independent = ladder.arrangement == Arrangement::random;
        const double sums = (1 - joint_power) * d / 2; // Monte Carlo: (dx/h)^(d/2)
        const double noise = independent ? sums + joint_power * irregular
                                         : 1 + d / 2 - joint_power * (model.noise_power + d / 2);
        const double low = without_field ? noise : std::min(noise, smoothing);
        // Three-dimensional ladders start where the wave is resolved so well that noise rules, even if it
        // falls faster.
        const bool either = model.transition || ladder.dimension == 3;
        double high = either && !without_field ? std::max(noise, low) : low;
        high = model.transition && !without_field ? std::max(high, smoothing) : high;
        high = squared_noise ? std::max(high, low + sums) : high;
        return around(low, high, "the slower of noise and smoothing: " + source);
    }
    if (is_truncated(ladder.arrangement)) {
        return around(model.truncated, model.truncated, "truncated support: " + source);
    }
    if (is_lattice(ladder.arrangement)) {
        const double order = without_field ? 0 : model.smoothing;
        return around(model.lattice_floor ? 0 : order, order,
                      "even kernel on a symmetric support" + (model.lattice_floor ? "; " + source : ""));
    }
    if (ladder.arrangement == Arrangement::polar) {
        // Sums along a ring do not feel its phase, but for rounding: the noise law is a bound, no more.
        return at_least(irregular, "no worse than noise: " + source);
    }
    const double high = model.transition && !without_field ? model.smoothing : irregular;
    return around(irregular, std::max(irregular, high), source);
}

std::vector<OperatorLadder> operator_ladders(std::string_view tier) {
    const std::vector<int> regular{16, 20, 28, 40, 56, 80};
    const std::vector<int> disordered{40, 56, 80, 112, 160};
    const std::vector<int> truncated{160, 226, 320, 453, 640};
    const std::vector<int> settled{80, 120, 160, 240, 320}; // whole tiles
    std::vector<OperatorLadder> ladders{
        {2, Arrangement::square, Path::fixed_ratio, regular, 2, 1},
        {2, Arrangement::hexagonal, Path::fixed_ratio, regular, 2, 1},
        {2, Arrangement::jittered_5, Path::fixed_ratio, {80, 112, 160, 224, 320}, 1.3, seeds_of_random},
        {2, Arrangement::jittered_10, Path::fixed_ratio, disordered, 1.3, seeds_of_random},
        {2, Arrangement::jittered_20, Path::fixed_ratio, disordered, 1.3, seeds_of_random},
        {2, Arrangement::settled, Path::fixed_ratio, settled, 1.3, seeds_of_random},
        {2, Arrangement::polar, Path::fixed_ratio, disordered, 1.3, seeds_of_random},
        {2, Arrangement::random, Path::fixed_ratio, disordered, 2, seeds_of_random},
        {2, Arrangement::edge, Path::fixed_ratio, truncated, 1.3, 1},
        {2, Arrangement::corner, Path::fixed_ratio, truncated, 1.3, 1},
        {2, Arrangement::jittered_20, Path::fixed_h, {30, 40, 60, 80, 120}, 1.5, seeds_of_random},
        {2, Arrangement::jittered_20, Path::joint, disordered, 1.3, seeds_of_random},
    };
    if (tier == "quick") {
        return ladders;
    }
    for (OperatorLadder& ladder : ladders) {
        if (ladder.n == disordered && ladder.arrangement != Arrangement::polar) {
            ladder.n = {40, 80, 160, 240, 320};
        }
    }
    // The other pairs of arrangement and path. There is no h fixed where the limit would be another: the
    // factor in front of the exact result is measured on a lattice, and an edge's limit is no multiple of it.
    for (const Arrangement arrangement : {Arrangement::jittered_5, Arrangement::jittered_10,
                                          Arrangement::random, Arrangement::settled, Arrangement::polar}) {
        const bool tiles = arrangement == Arrangement::settled;
        const std::vector<int> n =
            tiles ? std::vector{20, 40, 60, 80, 120} : std::vector{30, 40, 60, 80, 120};
        const double h_over_dx = tiles ? 1.2 : arrangement == Arrangement::random ? 3 : 1.5;
        ladders.push_back({2, arrangement, Path::fixed_h, n, h_over_dx, seeds_of_random});
    }
    for (const Arrangement arrangement : all_arrangements()) {
        if (arrangement != Arrangement::jittered_20) {
            const bool tiles = arrangement == Arrangement::settled;
            ladders.push_back({2, arrangement, Path::joint,
                               tiles                       ? std::vector{40, 60, 80, 120, 160}
                               : is_truncated(arrangement) ? truncated
                                                           : disordered,
                               is_lattice(arrangement) ? 2 : 1.3,
                               is_random(arrangement) ? seeds_of_random : 1});
        }
    }
    const std::vector<int> regular3{14, 20, 28, 40, 56};
    for (const Arrangement arrangement : {Arrangement::square, Arrangement::hexagonal}) {
        ladders.push_back({3, arrangement, Path::fixed_ratio, regular3, 1.5, 1});
    }
    const std::vector<int> blocks{160, 226, 320, 453, 640};
    for (const Arrangement arrangement :
         {Arrangement::jittered_5, Arrangement::jittered_10, Arrangement::jittered_20, Arrangement::settled,
          Arrangement::random}) {
        ladders.push_back({3, arrangement, Path::fixed_ratio, blocks, 1.3, seeds_of_random});
    }
    ladders.push_back(
        {3, Arrangement::polar, Path::fixed_ratio, {28, 40, 57, 80, 113}, 1.3, seeds_of_random});
    for (const Arrangement arrangement : {Arrangement::edge, Arrangement::corner}) {
        ladders.push_back({3, arrangement, Path::fixed_ratio, truncated, 1.3, 1});
    }
    ladders.push_back(
        {3, Arrangement::jittered_20, Path::fixed_h, {7, 10, 14, 20, 28}, 0.9, seeds_of_random});
    ladders.push_back({3, Arrangement::jittered_20, Path::joint, blocks, 1, seeds_of_random});
    return ladders;
}

std::vector<OperatorStudy> run_operator_studies(std::span<const Operator* const> operators,
                                                std::span<const OperatorLadder> ladders,
                                                const solver::Kernel& kernel,
                                                const OperatorProgress& progress) {
    std::vector<const Operator*> with_limit;
    std::copy_if(operators.begin(), operators.end(), std::back_inserter(with_limit),
                 [](const Operator* op) { return op->approximates != Approximates::nothing; });
    std::vector<OperatorStudy> studies;
    if (with_limit.empty()) {
        return studies;
    }
    std::size_t rungs = 0;
    for (const OperatorLadder& ladder : ladders) {
        rungs += ladder.n.size();
    }
    std::size_t done = 0;
    for (const OperatorLadder& ladder : ladders) {
        const auto tell = [&](int n) {
            ++done;
            if (progress) {
                progress(std::to_string(ladder.dimension) + "-D " +
                             std::string(to_string(ladder.arrangement)) + ", " +
                             std::string(to_string(ladder.path)) + ", n = " + std::to_string(n),
                         static_cast<double>(done) / static_cast<double>(rungs), n == ladder.n.back());
            }
        };
        auto found = ladder.dimension == 2 ? run_ladder<2>(with_limit, ladder, kernel, tell)
                                           : run_ladder<3>(with_limit, ladder, kernel, tell);
        std::move(found.begin(), found.end(), std::back_inserter(studies));
    }
    return studies;
}

} // namespace sphvv::verification
