#include "sphvv/verification/operator_fields.hpp"
#include "sphvv/verification/operator_study.hpp"

#include <benchmark/benchmark.h>
#include <omp.h>

#include <algorithm>
#include <map>
#include <memory>

namespace sphvv::verification {
namespace {

constexpr int repetitions = 5;
constexpr double seconds_of_one = 0.01;
constexpr int spacings = 40;

/// Keeps the time of every repetition instead of printing it.
class Collector : public benchmark::BenchmarkReporter {
public:
    bool ReportContext(const Context& /*context*/) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs) {
            if (run.run_type == Run::RT_Iteration) {
                times[run.run_name.function_name].push_back(run.GetAdjustedRealTime());
            }
        }
    }
    std::map<std::string, std::vector<double>> times; ///< ns
};

} // namespace

std::vector<OperatorCost> measure_costs(std::span<const solver::Operator* const> operators,
                                        const solver::Kernel& kernel) {
    OperatorScene<2> scene(particle_set<2>(Arrangement::jittered_20, spacings, 0, 1), kernel, 1.3 / spacings);
    PlaneWave<2>(scene.set.box).fill(scene);
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    benchmark::ClearRegisteredBenchmarks();
    for (const solver::Operator* op : operators) {
        benchmark::RegisterBenchmark(std::string(op->name).c_str(),
                                     [&scene, op](benchmark::State& state) {
                                         std::vector<std::vector<double>> columns(
                                             solver::result_components(op->approximates, 2),
                                             std::vector<double>(scene.set.size()));
                                         std::vector<double*> result;
                                         result.reserve(columns.size());
                                         for (std::vector<double>& column : columns) {
                                             result.push_back(column.data());
                                         }
                                         for (auto _ : state) {
                                             op->apply<2>(scene.input(), result);
                                             benchmark::ClobberMemory();
                                         }
                                     })
            ->Repetitions(repetitions)
            ->MinTime(seconds_of_one);
    }
    Collector collector;
    benchmark::RunSpecifiedBenchmarks(&collector);
    benchmark::ClearRegisteredBenchmarks();
    omp_set_num_threads(threads);
    const auto pairs = static_cast<double>(scene.neighbours.pairs());
    std::vector<OperatorCost> costs;
    for (const solver::Operator* op : operators) {
        std::vector<double> times = collector.times.at(std::string(op->name));
        std::sort(times.begin(), times.end());
        costs.push_back({std::string(op->name), 2, times[times.size() / 2] / (pairs * op->sweeps),
                         times.back() / times.front() - 1, pairs});
    }
    return costs;
}

std::vector<OperatorFront> operator_fronts(std::span<const OperatorStudy> studies,
                                           std::span<const OperatorCost> costs) {
    std::vector<OperatorFront> fronts;
    for (const char* cost : {"nanoseconds", "pair_evaluations"}) {
        std::map<std::string, OperatorFront> by_kind;
        for (const OperatorStudy& study : studies) {
            if (study.ladder.dimension != 2 || study.ladder.path != Path::fixed_ratio ||
                study.ladder.arrangement != Arrangement::jittered_10) {
                continue;
            }
            const auto found = std::find_if(costs.begin(), costs.end(), [&](const OperatorCost& each) {
                return each.op == study.op->name;
            });
            const bool timed = std::string_view(cost) == "nanoseconds";
            if (timed && found == costs.end()) {
                continue;
            }
            CostCurve curve{std::string(study.op->name), {}, {}};
            for (const OperatorSample& sample : study.samples) {
                if (sample.norms && sample.norms->l2 > 0) {
                    curve.error.push_back(sample.norms->l2);
                    curve.cost.push_back(sample.pair_evaluations * (timed ? found->nanoseconds_per_pair : 1));
                }
            }
            OperatorFront& front = by_kind[std::string(to_string(study.op->approximates))];
            front.approximates = to_string(study.op->approximates);
            front.cost = cost;
            front.curves.push_back(std::move(curve));
        }
        for (auto& [kind, front] : by_kind) {
            if (front.curves.size() > 1) {
                front.rows = cost_front(front.curves);
                fronts.push_back(std::move(front));
            }
        }
    }
    return fronts;
}

} // namespace sphvv::verification
