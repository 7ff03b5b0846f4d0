// Particles that nothing touches: alone, in pairs and lines, as spray, as a thin film.
#include "sphvv/verification/extreme_scenes.hpp"

#include <cmath>

namespace sphvv::verification::extreme_scenes {
namespace {

constexpr double dx = 0.02;
constexpr double step = 1e-3; // s
constexpr int steps = 200;

/// Every particle of the set with the same velocity.
PointScene thrown(std::vector<Point> places, const Point& velocity, double body_force) {
    PointScene scene{.places = std::move(places), .velocities = {}, .body_force = {0, -body_force}};
    scene.velocities.assign(scene.places.size(), velocity);
    return scene;
}

std::vector<Point> line(double angle) {
    constexpr int n = 20;
    std::vector<Point> places;
    places.reserve(n);
    for (int k = 0; k < n; ++k) {
        places.push_back({k * dx * std::cos(angle), k * dx * std::sin(angle)});
    }
    return places;
}

/// Drops that fly apart from one another, each farther than any kernel reaches from the next.
PointScene spray() {
    Uniform uniform(20261123);
    PointScene scene{.places = {}, .velocities = {}, .body_force = {0, -gravity}};
    for (int a = 0; a < 6; ++a) {
        for (int b = 0; b < 6; ++b) {
            scene.places.push_back({0.5 * a, 0.5 * b});
            scene.velocities.push_back({0.3 * uniform(), 0.3 * uniform()});
        }
    }
    return scene;
}

/// A block at rest, and a particle at 100 spacings from it.
PointScene block_and_stray() {
    std::vector<Point> places = block(10, 10, dx, {0, 0});
    places.insert(places.begin(), {-100 * dx, 0});
    return thrown(places, {0.3, -0.2}, 0);
}

/// m, of the first so many particles against the parabolas from their starts.
ExtremeOutcome fly(const std::string& scheme, PointScene scene, std::size_t measured) {
    scene.free_surface = has_free_surface(scheme);
    Simulation s = simulate(scheme, scene);
    return advance_and_measure(s, steps, [&](const Simulation& end) {
        std::vector<Point> exact(scene.places.begin(), scene.places.begin() + static_cast<long>(measured));
        for (std::size_t i = 0; i < measured; ++i) {
            exact[i][0] += scene.velocities[i][0] * end.time;
            exact[i][1] += scene.velocities[i][1] * end.time + scene.body_force[1] / 2 * end.time * end.time;
        }
        std::vector<Point> ours = places_of(end);
        ours.resize(measured);
        return largest_difference(ours, exact);
    });
}

/// The pressure answers to differences of velocity alone, and nothing else moves particles.
bool keeps_rigid(const std::string& scheme) {
    return scheme == "wcsph" || scheme == "isph_df" || scheme == "isph_lee";
}

struct Flight {
    std::string name;
    std::string must;
    std::string why;
    PointScene scene;
    bool falls = true;
    std::size_t measured = 0; ///< of the particles; 0: all
};

std::vector<Flight> flights() {
    const std::string rigid = "no difference of velocities, no pressure, so no force";
    std::vector<Flight> all{
        {"a single particle", "goes straight on; error: place, m", "no neighbour, no force",
         thrown({{0, 0}}, {0.3, -0.2}, 0), false},
        {"a single particle falls", "follows its parabola; error: place, m", "no neighbour, no force",
         thrown({{0, 0}}, {0.3, 2}, gravity)},
        {"a spray in free flight", "every drop follows its parabola; error: place, m",
         "no neighbour, no force", spray()},
        {"1000 g", "a particle follows its parabola; error: place, m", "no neighbour, no force",
         thrown({{0, 0}}, {0, 0}, 1000 * gravity)},
        {"two particles", "follow their parabolas; error: place, m", rigid,
         thrown({{0, 0}, {dx, 0}}, {0.3, 2}, gravity)},
        {"a line of particles", "follow their parabolas; error: place, m",
         rigid + "; the renormalisation matrix has rank 1 and is not inverted",
         thrown(line(0), {0.3, 2}, gravity)},
        {"a line of particles aslant", "follow their parabolas; error: place, m",
         rigid + "; the renormalisation matrix has rank 1 but for round-off and is not inverted",
         thrown(line(0.7), {0.3, 2}, gravity)},
        {"an empty neighbourhood", "a stray particle beside a block goes straight on; error: its place, m",
         "no neighbour, no force", block_and_stray(), false, 1}};
    for (const int rows : {1, 2, 3}) {
        all.push_back({"a film of " + std::to_string(rows) + (rows == 1 ? " row falls" : " rows falls"),
                       "every particle follows its parabola; error: place, m", rigid,
                       thrown(block(20, rows, dx, {0, 0}), {0.3, 2}, gravity)});
    }
    return all;
}

std::vector<ExtremeRow> rows() {
    std::vector<ExtremeRow> all;
    for (const Flight& flight : flights()) {
        add_for_all(all, [&](const std::string& scheme) {
            const double late = moves_with_new_velocity(scheme) && flight.falls
                                    ? -flight.scene.body_force[1] * steps * step * step / 2
                                    : 0;
            const std::size_t measured = flight.measured > 0 ? flight.measured : flight.scene.places.size();
            ExtremeRow row{.name = flight.name,
                           .scheme = scheme,
                           .must = flight.must,
                           .why = flight.why + (!flight.falls ? ""
                                                : late > 0 ? "; moved with the new velocity: off by g t dt/2"
                                                           : "; moved with the mean of old and new velocity: "
                                                             "exact"),
                           .fate = Fate::bounded,
                           .bound = late * (1 + 1e-9) + round_off * (flight.name == "1000 g" ? 1000 : 1),
                           .run = [scene = flight.scene, measured](const std::string& of) {
                               return fly(of, scene, measured);
                           }};
            if (flight.name == "a film of 3 rows falls" && !keeps_rigid(scheme)) {
                row.fate = Fate::survives;
                row.why = "the middle row is no surface: shifts, or its summed density, move it";
            }
            if (flight.name == "an empty neighbourhood" && scheme == "isph_dfdi") {
                row.waiver = cut_density + "the block leaves the stray particle alone: 7e-15";
            }
            if (flight.name == "a film of 3 rows falls" && needs_polynomial(scheme)) {
                row.must = "survives; error: place, m";
                row.why = "three rows lie on no conic; nothing is claimed of extrapolated polynomials";
                row.fate = Fate::survives;
            } else if (needs_polynomial(scheme)) {
                row.must = "ends: a polynomial is not determined";
                row.why = "moving least squares needs six points that lie on no conic";
                row.fate = Fate::ends;
                row.diagnoses = {"the neighbours of particle"};
            }
            return row;
        });
    }
    return all;
}

} // namespace

const ExtremeScenes& free_flight() {
    static const ExtremeScenes scenes{"free_flight", "particles that nothing touches", rows};
    return scenes;
}

} // namespace sphvv::verification::extreme_scenes
