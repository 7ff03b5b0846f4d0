// Somebody else's program: judges its own errors with our norms and orders. Exits 0 if order 2 is recognised.
#include <cstdio>
#include <sphvv/verification/norms.hpp>
#include <sphvv/verification/order.hpp>
#include <vector>

int main() {
    using namespace sphvv::verification;
    std::vector<Rung> ladder;
    for (const double h : {0.1, 0.05, 0.025, 0.0125}) {
        const std::vector<double> exact{1, 2};
        const std::vector<double> ours{1 + h * h, 2 - h * h};
        const std::vector<double> volume{0.5, 0.5};
        ladder.push_back({h, {scalar_norms(ours, exact, volume).l2}});
    }
    const Judgement judgement = judge(ladder, {1.9, 2.1, "by construction"});
    std::printf("%s\n", judgement.reason.c_str());
    return judgement.verdict == Verdict::pass ? 0 : 1;
}
