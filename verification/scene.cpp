#include "sphvv/verification/scene.hpp"

#include "sphvv/analytic/solutions.hpp"
#include "sphvv/solver/arrangements.hpp"
#include "sphvv/solver/boundaries/shapes/signed_distance.hpp"
#include "sphvv/solver/boundaries/wall_methods.hpp"
#include "sphvv/solver/unstructured.hpp"
#include "sphvv/verification/particle_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sphvv::verification {
namespace {

using solver::Key;
using solver::shortest;

bool declares(std::span<const Key> keys, std::string_view name) {
    return std::any_of(keys.begin(), keys.end(), [&](const Key& key) { return key.name == name; });
}

std::string key_names(std::span<const Key> keys) {
    std::string names;
    for (const Key& key : keys) {
        names += (names.empty() ? "" : ", ") + key.name;
    }
    return names;
}

constexpr double largest_particle_count = 2e7; // about 20 GB with the neighbour lists of a 3-D scene

const solver::WallMethodEntry& wall_method(const SceneRecord& scene) {
    return solver::wall_methods::find(scene.case_settings.word("wall_method"));
}

/// Whether a row of wall particles lies on the walls.
bool rows_on_walls(const SceneRecord& scene) {
    return scene.case_settings.has("wall_method") && wall_method(scene).row_on_wall;
}

/// Whether points on the walls repel the fluid.
bool walls_repel(const SceneRecord& scene) {
    return scene.case_settings.has("wall_method") && wall_method(scene).repulsion;
}

/// The rows of fluid particles in one direction.
struct Rows {
    double first = 0;
    double spacing = 0;
    int count = 0;
    bool low_row = false; ///< a row of wall particles or points at the low side
    bool high_row = false;

    double at(int k) const { return first + k * spacing; }
};

/// From the last row of the fluid to either side of the domain, in spacings: half a one at a periodic side, a
/// surface and a wall; a whole one at a wall that has a row of its own; none at a surface on which the
/// uppermost row is to lie.
using Ends = std::array<std::array<double, 2>, 3>;

bool is_wall(const analytic::Boundary& boundary) {
    return boundary.kind != analytic::BoundaryKind::free_surface;
}

/// Those of the solution, and the smooth walls that close the scene.
std::vector<analytic::Boundary> boundaries_with(const Case& flow, const analytic::Values& values) {
    const analytic::Solution& solution = analytic::solutions::find(flow.solution);
    std::vector<analytic::Boundary> all = analytic::boundaries(solution, values);
    for (const analytic::Face& face : flow.closed) {
        all.push_back(analytic::flat_boundary("end wall", analytic::BoundaryKind::impermeable,
                                              solution.domain(values), face));
    }
    return all;
}

/// They do not depend on the values of the parameters.
Ends ends_of(const SceneRecord& scene) {
    const analytic::Solution& solution = analytic::solutions::find(scene.flow->solution);
    Ends ends{{{0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}}};
    for (const analytic::Boundary& boundary : boundaries_with(*scene.flow, analytic::resolve(solution, {}))) {
        if (boundary.face) {
            double& end = ends[boundary.face->direction][boundary.face->high ? 1 : 0];
            if (is_wall(boundary)) {
                end = rows_on_walls(scene) ? 1 : 0.5;
            } else {
                end = scene.case_settings.word("surface_row") == "on" ? 0 : 0.5;
            }
        }
    }
    return ends;
}

struct Layout {
    double dx;
    std::array<Rows, 3> rows;
};

std::vector<analytic::Boundary> boundaries_of(const SceneRecord& scene) {
    return boundaries_with(*scene.flow, solution_values(scene));
}

/// The domain that the lattice fills.
analytic::Domain lattice_domain(const SceneRecord& scene) {
    analytic::Values values = solution_values(scene);
    if (scene.flow->hooks.lattice_values) {
        scene.flow->hooks.lattice_values(scene, values);
    }
    return analytic::solutions::find(scene.flow->solution).domain(values);
}

Layout layout_of(const SceneRecord& scene, const analytic::Domain& domain, int dimension) {
    Layout layout{spacing_of(scene), {}};
    const Ends ends = ends_of(scene);
    for (int d = 0; d < dimension; ++d) {
        const double side = domain.high[d] - domain.low[d];
        const auto [low, high] = ends[d];
        const double count = side / layout.dx - low - high + 1;
        const long rows = std::lround(count);
        if (rows < 1 || std::abs(count - static_cast<double>(rows)) > 1e-9 * side / layout.dx) {
            throw UserError(std::string(scene.flow->name) + " at n = " + std::to_string(scene.n) +
                            ": a side of " + shortest(side) + " m is no whole number of rows " +
                            shortest(layout.dx) + " m apart; give another n, length or wall_method");
        }
        const double spacing = side / (static_cast<double>(rows) - 1 + low + high);
        layout.rows[d] = {domain.low[d] + low * spacing, spacing, static_cast<int>(rows), low == 1,
                          high == 1};
    }
    return layout;
}

constexpr double headroom = 4; // for jets, in depths

/// The box of the domain, with room above a free surface.
template <int Dim>
solver::Box<Dim> box_of(const SceneRecord& scene, const analytic::Domain& domain) {
    solver::Box<Dim> box;
    for (int d = 0; d < Dim; ++d) {
        box.low[d] = domain.low[d];
        box.high[d] = domain.high[d];
        box.periodic[d] = domain.periodic[d];
    }
    for (const analytic::Boundary& boundary : boundaries_of(scene)) {
        if (boundary.face && !is_wall(boundary)) {
            const int d = boundary.face->direction;
            (boundary.face->high ? box.high[d] : box.low[d]) +=
                (boundary.face->high ? headroom : -headroom) * (domain.high[d] - domain.low[d]);
        }
    }
    return box;
}

template <int Dim>
using Points = std::array<std::vector<double>, Dim>;

/// Every point of a grid, direction 0 fastest.
template <int Dim>
Points<Dim> grid(const std::array<std::vector<double>, Dim>& along) {
    Points<Dim> points;
    std::size_t count = 1;
    for (const auto& axis : along) {
        count *= axis.size();
    }
    for (std::size_t k = 0; k < count; ++k) {
        std::size_t rest = k;
        for (int d = 0; d < Dim; ++d) {
            points[d].push_back(along[d][rest % along[d].size()]);
            rest /= along[d].size();
        }
    }
    return points;
}

template <int Dim>
std::array<std::vector<double>, Dim> fluid_axes(const Layout& layout) {
    std::array<std::vector<double>, Dim> along;
    for (int d = 0; d < Dim; ++d) {
        for (int k = 0; k < layout.rows[d].count; ++k) {
            along[d].push_back(layout.rows[d].at(k));
        }
    }
    return along;
}

/// Rows of wall particles behind the one on the wall. The first row of the fluid is dx from the wall: its
/// support reaches that less beyond.
int layers_behind(const SceneRecord& scene) {
    if (!wall_method(scene).layers_behind) {
        return 0;
    }
    const solver::Kernel& kernel = solver::kernels::find(scene.scheme_settings.word("kernel"));
    return static_cast<int>(std::ceil(kernel.support * scene.scheme_settings.number("h_over_dx") - 1));
}

/// Wall particles on the sides that have a row: beside the fluid's, and in the corners, each in one row.
/// With wall_method=fixed, also behind them as far as a support reaches.
template <int Dim>
std::vector<solver::WallParticle<Dim>> wall_rows(const SceneRecord& scene, const Layout& layout,
                                                 const analytic::Domain& domain) {
    std::vector<solver::WallParticle<Dim>> particles;
    int wall = 0;
    for (const analytic::Boundary& boundary : boundaries_of(scene)) {
        if (!is_wall(boundary)) {
            continue;
        }
        if (boundary.face && rows_on_walls(scene) && !walls_repel(scene)) {
            auto along = fluid_axes<Dim>(layout);
            const int across = boundary.face->direction;
            for (int d = 0; d < across; ++d) {
                for (int layer = 0; layer <= layers_behind(scene); ++layer) {
                    const double behind = layer * layout.rows[d].spacing;
                    if (layout.rows[d].low_row) {
                        along[d].insert(along[d].begin(), domain.low[d] - behind);
                    }
                    if (layout.rows[d].high_row) {
                        along[d].push_back(domain.high[d] + behind);
                    }
                }
            }
            along[across].clear();
            for (int layer = 0; layer <= layers_behind(scene); ++layer) {
                const double behind = layer * layout.rows[across].spacing;
                along[across].push_back(boundary.face->high ? domain.high[across] + behind
                                                            : domain.low[across] - behind);
            }
            const Points<Dim> points = grid<Dim>(along);
            for (std::size_t k = 0; k < points[0].size(); ++k) {
                solver::Vector<Dim> x;
                for (int d = 0; d < Dim; ++d) {
                    x[d] = points[d][k];
                }
                particles.push_back({wall, x});
            }
        }
        ++wall;
    }
    return particles;
}

/// Points that repel, on every wall as far as the box goes: that is, where the fluid may rise to.
template <int Dim>
std::vector<solver::WallParticle<Dim>> repelling_points(const SceneRecord& scene, const Layout& layout,
                                                        const solver::Box<Dim>& box) {
    const int per_dx = static_cast<int>(scene.case_settings.integer("points_per_dx"));
    std::vector<solver::WallParticle<Dim>> particles;
    int wall = 0;
    for (const analytic::Boundary& boundary : boundaries_of(scene)) {
        if (!is_wall(boundary)) {
            continue;
        }
        std::array<std::vector<double>, Dim> along;
        const int across = boundary.face->direction;
        for (int d = 0; d < Dim; ++d) {
            const double spacing = layout.rows[d].spacing / per_dx;
            const double intervals = box.length(d) / spacing;
            const long count =
                box.periodic[d] ? std::lround(intervals) : std::lround(std::ceil(intervals)) + 1;
            for (long k = 0; k < count && d != across; ++k) {
                const double from_low = static_cast<double>(k) + (box.periodic[d] ? 0.5 : 0);
                along[d].push_back(box.low[d] + from_low * spacing);
            }
        }
        along[across] = {boundary.face->high ? box.high[across] : box.low[across]};
        const Points<Dim> points = grid<Dim>(along);
        for (std::size_t k = 0; k < points[0].size(); ++k) {
            solver::Vector<Dim> x;
            for (int d = 0; d < Dim; ++d) {
                x[d] = points[d][k];
            }
            particles.push_back({wall, x});
        }
        ++wall;
    }
    return particles;
}

template <int Dim>
analytic::Vector analytic_point(const solver::Vector<Dim>& x) {
    analytic::Vector point{};
    std::copy_n(x.data(), Dim, point.begin());
    return point;
}

template <int Dim>
solver::Vector<Dim> solver_vector(const analytic::Vector& v) {
    solver::Vector<Dim> result;
    std::copy_n(v.begin(), Dim, result.data());
    return result;
}

/// The walls of the solution, in its order.
template <int Dim>
std::vector<solver::Wall<Dim>> walls_of(const SceneRecord& scene) {
    std::vector<solver::Wall<Dim>> walls;
    const double step = 1e-6 * scene.case_settings.number(scene.flow->reference_length);
    for (const analytic::Boundary& boundary : boundaries_of(scene)) {
        if (!is_wall(boundary)) {
            continue;
        }
        const auto distance = [boundary](const solver::Vector<Dim>& x) {
            return boundary.distance(analytic_point<Dim>(x));
        };
        // A plane moves along its normal with a constant velocity, if at all; until t = 0 it is at rest.
        solver::Vector<Dim> normal_velocity = solver::Vector<Dim>::Zero();
        if (boundary.face) {
            normal_velocity[boundary.face->direction] = boundary.velocity({}, 1)[boundary.face->direction];
        }
        const bool moves = !normal_velocity.isZero(0);
        solver::Wall<Dim> wall{
            .name = std::string(boundary.name),
            .slip = boundary.kind == analytic::BoundaryKind::no_slip ? solver::Slip::no_slip
                                                                     : solver::Slip::free_slip,
            .distance = distance,
            .normal = solver::shapes::gradient_of<Dim>(distance, step),
            .velocity =
                [boundary, moves](const solver::Vector<Dim>& x, double t) {
                    return moves && t <= 0 ? solver::Vector<Dim>(solver::Vector<Dim>::Zero())
                                           : solver_vector<Dim>(boundary.velocity(analytic_point<Dim>(x), t));
                },
            .displacement = {}};
        if (moves) {
            wall.displacement = [normal_velocity](double t) {
                return solver::Vector<Dim>(t * normal_velocity);
            };
        }
        walls.push_back(std::move(wall));
    }
    return walls;
}

int tile_of(int dimension) {
    return dimension == 2 ? settled_tile<2> : settled_tile<3>;
}

/// A settled tile is repeated in a cube.
void check_settled(const SceneRecord& scene, const analytic::Domain& domain, int dimension,
                   const std::string& where) {
    const double length = scene.case_settings.number(scene.flow->reference_length);
    for (int d = 0; d < dimension; ++d) {
        if (std::abs(domain.high[d] - domain.low[d] - length) > 1e-9 * length) {
            throw UserError(where + ": a settled start needs a box whose sides are all the reference length; "
                                    "accepted: arrangement=lattice, arrangement=jittered");
        }
    }
    if (scene.n % tile_of(dimension) != 0) {
        throw UserError(where + ": a settled start repeats a tile of " + std::to_string(tile_of(dimension)) +
                        " spacings; give a multiple of it");
    }
}

template <int Dim>
std::array<std::vector<double>, Dim> settled_points(const solver::Box<Dim>& box, const SceneRecord& scene) {
    auto points = particle_set<Dim>(Arrangement::settled, scene.n, 0, scene.seed).points;
    for (int d = 0; d < Dim; ++d) {
        for (double& x : points[d]) {
            x = box.low[d] + (box.high[d] - box.low[d]) * x;
        }
    }
    return points;
}

} // namespace

/// The solution's parameters as they are set.
static analytic::Values declared_values(const SceneRecord& scene) {
    analytic::Values values;
    for (const analytic::Parameter& p : analytic::solutions::find(scene.flow->solution).parameters) {
        values.emplace(p.name,
                       scene.case_settings.has(p.name) ? scene.case_settings.number(p.name) : p.value);
    }
    return values;
}

analytic::Values solution_values(const SceneRecord& scene) {
    analytic::Values values = declared_values(scene);
    if (scene.flow->columns > 0) {
        values["length"] = scene.case_settings.integer("columns") * spacing_of(scene);
    }
    if (scene.flow->hooks.values) {
        scene.flow->hooks.values(scene, values);
    }
    return values;
}

int dimension(const SceneRecord& scene) {
    return analytic::solutions::find(scene.flow->solution).dimension;
}

std::string Variant::label() const {
    std::string text(scheme->name);
    for (const auto& [key, value] : settings) {
        text.append(":").append(key).append("=").append(value);
    }
    return text;
}

Variant variant_of(std::string_view text) {
    const std::size_t colon = std::min(text.find(':'), text.size());
    Variant variant(&solver::schemes::find(text.substr(0, colon)));
    for (std::size_t at = colon; at < text.size();) {
        const std::size_t next = std::min(text.find(':', at + 1), text.size());
        const std::string_view assignment = text.substr(at + 1, next - at - 1);
        const std::size_t equals = assignment.find('=');
        if (equals == std::string_view::npos || equals == 0 || equals + 1 == assignment.size()) {
            throw UserError("scheme '" + std::string(text) + "': '" + std::string(assignment) +
                            "' is not of the form KEY=VALUE; accepted: SCHEME[:KEY=VALUE…]");
        }
        const auto [key, value] = std::pair{assignment.substr(0, equals), assignment.substr(equals + 1)};
        if (!variant.settings.emplace(std::string(key), std::string(value)).second) {
            throw UserError("scheme '" + std::string(text) + "': the key '" + std::string(key) +
                            "' is given twice");
        }
        at = next;
    }
    return variant;
}

SceneRecord resolve_scene(const Case& flow, const Variant& variant, const solver::Assignments& given, int n,
                          std::span<const Key> also_known) {
    const solver::Scheme& scheme = *variant.scheme;
    const std::vector<Key> of_case = case_keys(flow);
    solver::Assignments to_case;
    solver::Assignments to_scheme;
    solver::Assignments all = variant.settings;
    all.insert(given.begin(), given.end());
    for (const auto& [key, value] : all) {
        if (declares(of_case, key)) {
            to_case[key] = value;
        } else if (declares(scheme.keys, key)) {
            to_scheme[key] = value;
        } else if (variant.settings.contains(key) || !declares(also_known, key)) {
            throw UserError("there is no key '" + key + "'; the case " + std::string(flow.name) + " takes " +
                            key_names(of_case) + "; the scheme " + std::string(scheme.name) + " takes " +
                            key_names(scheme.keys));
        }
    }
    return {.flow = &flow,
            .scheme = &scheme,
            .label = variant.label(),
            .case_settings = solver::Settings(of_case, to_case),
            .scheme_settings = solver::Settings(scheme.keys, to_scheme),
            .n = n};
}

namespace {

/// Smallest sum (m) of the distances of a point in the fluid from two walls that are no sides of the domain,
/// over a grid of 64 points to a side: the width of the gap between them, as long as it is wider than the
/// grid.
double narrowest_gap(const std::vector<analytic::Boundary>& boundaries, const analytic::Domain& domain,
                     int dimension) {
    constexpr int points = 64;
    double narrowest = std::numeric_limits<double>::infinity();
    const int count = static_cast<int>(std::lround(std::pow(points, dimension)));
    for (int k = 0; k < count; ++k) {
        analytic::Vector x{};
        int rest = k;
        for (int d = 0; d < dimension; ++d) {
            x[d] = domain.low[d] + (rest % points + 0.5) / points * (domain.high[d] - domain.low[d]);
            rest /= points;
        }
        std::array<double, 2> nearest;
        nearest.fill(std::numeric_limits<double>::infinity());
        for (const analytic::Boundary& boundary : boundaries) {
            if (is_wall(boundary) && !boundary.face) {
                const double distance = boundary.distance(x);
                nearest[1] = std::min(nearest[1], std::max(nearest[0], distance));
                nearest[0] = std::min(nearest[0], distance);
            }
        }
        if (nearest[0] > 0) {
            narrowest = std::min(narrowest, nearest[0] + nearest[1]);
        }
    }
    return narrowest;
}

} // namespace

void check_scene(const SceneRecord& scene) {
    const analytic::Solution& solution = analytic::solutions::find(scene.flow->solution);
    const analytic::Domain domain = lattice_domain(scene);
    const Layout layout = layout_of(scene, domain, solution.dimension);
    const solver::Kernel& kernel = solver::kernels::find(scene.scheme_settings.word("kernel"));
    const double support = kernel.support * scene.scheme_settings.number("h_over_dx") * layout.dx;
    const std::string where = "n = " + std::to_string(scene.n) + " for " + std::string(scene.scheme->name) +
                              " on " + std::string(scene.flow->name);
    double particles = 1;
    for (int d = 0; d < solution.dimension; ++d) {
        const double side = domain.high[d] - domain.low[d];
        particles *= side / layout.dx;
        if (scene.flow->columns > 0 && d == 0 && side < 2 * support * (1 - 1e-12)) {
            throw UserError(
                where + ": a periodic box must hold two kernel supports of " + shortest(support / layout.dx) +
                " dx each; give columns >= " + shortest(std::ceil(2 * support / layout.dx - 1e-9)));
        }
        // Beyond a wall as much is reflected as a support reaches.
        const double needed = domain.periodic[d] ? 2 * support : support;
        if (side < needed * (1 - 1e-12)) {
            throw UserError(where +
                            (domain.periodic[d] ? ": a periodic box must hold two kernel supports of "
                                                : ": a box between walls must hold a kernel support of ") +
                            shortest(support / layout.dx) + (domain.periodic[d] ? " dx each" : " dx") +
                            "; give n >= " + shortest(std::ceil(needed / side * scene.n - 1e-9)));
        }
    }
    const auto boundaries = boundaries_of(scene);
    const double gap = narrowest_gap(boundaries, domain, solution.dimension);
    if (gap < support * (1 - 1e-12)) {
        throw UserError(where + ": the gap between its walls must hold a kernel support of " +
                        shortest(support / layout.dx) +
                        " dx; give n >= " + shortest(std::ceil(support / gap * scene.n - 1e-9)));
    }
    if (rows_on_walls(scene) &&
        std::ranges::any_of(boundaries, [](const auto& b) { return is_wall(b) && !b.face; })) {
        throw UserError(where + ": wall particles lie along plane walls only; give wall_method=mirror");
    }
    if (scene.case_settings.has("wall_method") && wall_method(scene).compressible_only &&
        !scene.scheme->compressible) {
        throw UserError(
            where + ": wall_method=" + std::string(wall_method(scene).name) +
            " needs a scheme whose density evolves (wcsph); give wall_method=mirror, mirror_row or "
            "dummy");
    }
    const auto sticks = [](const auto& b) { return b.kind == analytic::BoundaryKind::no_slip; };
    if (walls_repel(scene) && solution.medium(solution_values(scene)).kinematic_viscosity > 0 &&
        std::ranges::any_of(boundaries, sticks)) {
        throw UserError(where + ": wall_method=" + std::string(wall_method(scene).name) +
                        " carries no shear: it needs walls with free slip or a fluid without viscosity; give "
                        "wall_method=mirror, mirror_row, dummy or fixed");
    }
    if (scene.case_settings.word("arrangement") == "settled") {
        check_settled(scene, domain, solution.dimension, where);
    }
    if (particles > largest_particle_count) {
        throw UserError(where + " makes " + shortest(std::round(particles)) + " particles; at most " +
                        shortest(largest_particle_count) + " are accepted");
    }
}

namespace {

/// As many points as the rows have, without structure, in the part of the domain that the rows fill.
template <int Dim>
Points<Dim> unstructured_points(const Layout& layout, const analytic::Domain& domain, std::uint64_t seed) {
    solver::Box<Dim> box;
    std::size_t count = 1;
    for (int d = 0; d < Dim; ++d) {
        const Rows& rows = layout.rows[d];
        box.low[d] = rows.first - rows.spacing / 2;
        box.high[d] = rows.at(rows.count - 1) + rows.spacing / 2;
        box.periodic[d] = domain.periodic[d];
        count *= static_cast<std::size_t>(rows.count);
    }
    return solver::unstructured<Dim>(box, count, seed);
}

template <int Dim>
Points<Dim> fluid_points(const SceneRecord& scene, const Layout& layout, const analytic::Domain& domain) {
    const std::string& arrangement = scene.case_settings.word("arrangement");
    Points<Dim> points = arrangement == "settled" ? settled_points<Dim>(box_of<Dim>(scene, domain), scene)
                         : arrangement == "unstructured"
                             ? unstructured_points<Dim>(layout, domain, scene.seed)
                             : grid<Dim>(fluid_axes<Dim>(layout));
    if (arrangement == "jittered") {
        solver::jitter<Dim>(points, scene.case_settings.number("jitter") * layout.dx, scene.seed);
    }
    if constexpr (Dim == 2) {
        if (scene.flow->hooks.arrange) {
            scene.flow->hooks.arrange(scene, points);
        }
    }
    return points;
}

/// m^dim that a fluid particle stands for.
double particle_volume(const Layout& layout, int dimension) {
    double volume = 1;
    for (int d = 0; d < dimension; ++d) {
        volume *= layout.rows[d].spacing;
    }
    return volume;
}

/// Nothing feeds a flow that no force drives and no wall drags: it keeps to the energy that it starts with.
solver::SurvivalBounds bounds_of(const SceneRecord& scene, const analytic::Values& values, double volume,
                                 double speed, double dx) {
    const analytic::Solution& solution = analytic::solutions::find(scene.flow->solution);
    const analytic::Medium medium = solution.medium(values);
    const bool driven = !boundaries_of(scene).empty() || medium.body_force != analytic::Vector{};
    const double energy = driven ? 0.5 * speed * speed : solution.kinetic_energy(values, 0);
    return {.kinetic_energy = scene.case_settings.number("maximum_energy") * medium.density * volume * energy,
            .minimum_spacing = scene.case_settings.number("minimum_spacing") * dx,
            .kinetic_energy_reason =
                scene.case_settings.text("maximum_energy") +
                (driven ? " times that of all fluid at the largest speed that is expected"
                        : " times its start value in an undriven flow"),
            .minimum_spacing_reason = "arrangement lost"};
}

template <int Dim>
void set_start(const SceneRecord& scene, const analytic::Evaluator& exact, solver::Simulation<Dim>& s) {
    solver::Particles<Dim>& particles = s.particles;
    solver::Field& pressure = particles.field("pressure", 1, solver::Lifetime::state, "scene");
    for (std::size_t i = 0; i < particles.size(); ++i) {
        solver::Vector<Dim> x;
        for (int d = 0; d < Dim; ++d) {
            x[d] = particles.position[d][i];
        }
        analytic::State state = exact(analytic_point<Dim>(x), 0);
        const bool of_wall = i >= particles.fluid_size();
        const auto velocity = of_wall
                                  ? s.walls[s.wall_particles[i - particles.fluid_size()].wall].velocity(x, 0)
                                  : solver_vector<Dim>(state.velocity);
        for (int d = 0; d < Dim; ++d) {
            particles.velocity[d][i] = scene.flow->starts_at_rest && !of_wall ? 0 : velocity[d];
        }
        pressure[0][i] = std::isfinite(state.pressure) ? state.pressure : 0;
    }
}

} // namespace

/// The parameter, or the side of the domain that it is to stand for.
static double reference_length(const SceneRecord& scene) {
    const int side = scene.flow->reference_side;
    if (side < 0) {
        return scene.case_settings.number(scene.flow->reference_length);
    }
    const analytic::Domain domain =
        analytic::solutions::find(scene.flow->solution).domain(declared_values(scene));
    return domain.high[side] - domain.low[side];
}

double spacing_of(const SceneRecord& scene) {
    double excess = 0;
    for (const auto& [low, high] : ends_of(scene)) {
        excess = low + high != 1 && low + high != 2 ? low + high - 1 : excess;
    }
    return reference_length(scene) / (scene.n + excess);
}

template <int Dim>
solver::Simulation<Dim> build_scene(const SceneRecord& scene) {
    check_scene(scene);
    const analytic::Solution& solution = analytic::solutions::find(scene.flow->solution);
    const analytic::Values values = solution_values(scene);
    const analytic::Medium medium = solution.medium(values);
    const analytic::Domain domain = lattice_domain(scene);
    const Layout layout = layout_of(scene, domain, Dim);
    const auto& hooks = scene.flow->hooks;

    const Points<Dim> points = fluid_points<Dim>(scene, layout, domain);
    const auto wall_particles = wall_rows<Dim>(scene, layout, domain);
    const std::size_t fluid = points[0].size();
    solver::Simulation<Dim> simulation(box_of<Dim>(scene, domain), fluid + wall_particles.size(),
                                       wall_particles.size());
    simulation.settings = scene.scheme_settings;
    simulation.kernel = &solver::kernels::find(scene.scheme_settings.word("kernel"));
    simulation.particle_spacing = layout.dx;
    simulation.smoothing_length = scene.scheme_settings.number("h_over_dx") * layout.dx;
    simulation.density = medium.density;
    simulation.kinematic_viscosity = medium.kinematic_viscosity;
    simulation.reference_speed =
        hooks.reference_speed ? hooks.reference_speed(scene, values) : medium.maximum_speed;
    const auto body_force_at = [&solution, values](double t) {
        std::array<double, Dim> force;
        std::copy_n(analytic::body_force(solution, values, t).begin(), Dim, force.begin());
        return force;
    };
    simulation.body_force = body_force_at(0);
    if (solution.body_force != nullptr) {
        simulation.body_force_at = body_force_at;
    }
    const double volume = particle_volume(layout, Dim);
    simulation.particle_mass = medium.density * volume;
    simulation.end_time = scene.case_settings.number("end_time");
    simulation.survival =
        bounds_of(scene, values, volume * static_cast<double>(fluid), simulation.reference_speed, layout.dx);
    simulation.walls = walls_of<Dim>(scene);
    simulation.wall_particles = wall_particles;
    if (scene.case_settings.has("wall_method")) {
        simulation.wall_pressure = scene.case_settings.word("wall_pressure") == "even"
                                       ? solver::WallPressure::even
                                       : solver::WallPressure::inertial;
        simulation.wall_method = wall_method(scene).method;
    }
    if (walls_repel(scene)) {
        const double U = simulation.reference_speed;
        simulation.repulsion.emplace(
            solver::RepulsiveLaw{*wall_method(scene).repulsion,
                                 scene.case_settings.number("repulsion") * U * U, layout.dx,
                                 static_cast<int>(scene.case_settings.integer("points_per_dx"))},
            repelling_points<Dim>(scene, layout, simulation.box), simulation.box);
    }
    if (scene.case_settings.has("surface_detector")) {
        const solver::Detector& detector =
            solver::free_surface::find(scene.case_settings.word("surface_detector"));
        simulation.free_surface = solver::FreeSurface{
            &detector,
            detector.threshold(Dim, simulation.kernel->support * scene.scheme_settings.number("h_over_dx"))};
    }
    for (int d = 0; d < Dim; ++d) {
        auto& x = simulation.particles.position.components[d];
        x = points[d];
        for (const auto& particle : wall_particles) {
            x.push_back(particle.position[d]);
        }
    }
    solver::wrap_positions(simulation); // a jittered particle may have left the box
    set_start(scene, solution.bind(values), simulation);
    if constexpr (Dim == 2) {
        if (hooks.prepare) {
            hooks.prepare(scene, simulation);
        }
    }
    scene.scheme->assemble(simulation);
    if constexpr (Dim == 2) {
        if (hooks.complete) {
            hooks.complete(scene, simulation);
        }
    }
    return simulation;
}

template solver::Simulation<2> build_scene<2>(const SceneRecord&);
template solver::Simulation<3> build_scene<3>(const SceneRecord&);

} // namespace sphvv::verification
