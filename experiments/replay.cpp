#include "experiments/replay.h"

#include <fmt/format.h>

#include "core/error.h"
#include "scene/scene.h"

namespace gradslc {
namespace {

std::string text_of(Vec3 v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }
std::string text_of(Point3 p) { return text_of(from_origin(p)); }
std::string text_of(Normal3 n) { return text_of(as_vec(n)); }
std::string text_of(Rgb c) { return text_of(Vec3{c.r, c.g, c.b}); }
/// With all digits, to be compared bit by bit.
std::string exact_text_of(Rgb c) { return fmt::format("({}, {}, {})", c.r, c.g, c.b); }
std::string place_of(const std::optional<Point3>& position) {
  return position ? "at " + text_of(*position) : "at infinity";
}

bool brings_light(const Happening& what) {
  return std::holds_alternative<happening::EmitterHit>(what) || std::holds_alternative<happening::NextEvent>(what) ||
         std::holds_alternative<happening::VplConnection>(what);
}

/// Writes what happened, line by line, indented by what it belongs to: a vertex, a compensation ray.
class Writer {
 public:
  Writer(const Scene& scene, float largest) : scene_(scene), largest_(largest) {}

  void write(const PathLog::Entry& entry) {
    const int indent = std::visit([&](const auto& what) { return write(what); }, entry.what);
    if (brings_light(entry.what)) write_value(entry, indent + 1);
  }
  void line(int indent, const std::string& text) { text_ += fmt::format("{:{}}{}\n", "", 2 * indent, text); }
  const std::string& text() const { return text_; }

 private:
  static constexpr int k_ray_indent = 1;
  int path_indent() const { return in_ray_ ? k_ray_indent + 1 : 0; }

  // Each returns its line's indent.
  int write(const happening::Vertex& v) {
    const int indent = path_indent();
    line(indent, fmt::format("vertex {} at {}, normal {}, {}", v.edges, text_of(v.position), text_of(v.shading_normal),
                             material(v.material)));
    line(indent + 1, fmt::format("throughput {}; energy of lobes: connectable {:.4g}, other {:.4g}; passes straight on "
                                 "with probability {:.4g}",
                                 text_of(v.throughput), v.connectable_energy, v.other_energy, v.pass_probability));
    return indent;
  }
  int write(const happening::Crossing&) {
    line(path_indent() + 1, "passes straight on");
    return path_indent() + 1;
  }
  int write(const happening::Gather& gather) {
    line(path_indent() + 1, fmt::format("gathers with throughput {}", text_of(gather.throughput)));
    return path_indent() + 1;
  }
  int write(const happening::CompensationRay& ray) {
    end_ray();
    line(k_ray_indent, fmt::format("compensation ray {}, what it brings times {:.6g}", ray.index + 1, ray.scale));
    in_ray_ = true;
    return k_ray_indent;
  }
  int write(const happening::CompensationEnd&) {
    end_ray();
    return k_ray_indent;
  }
  int write(const happening::EmitterHit& hit) {
    line(path_indent(), fmt::format("emitter {} after {} edges: radiance {}, MIS weight {:.4g}", place_of(hit.position),
                                    hit.edges, text_of(hit.radiance), hit.mis_weight));
    return path_indent();
  }
  int write(const happening::NextEvent& e) {
    const int indent = path_indent() + 1;
    line(indent, fmt::format("next event {} in direction {}, {} edges: radiance {}, pdf {:.6g}{}, MIS weight {:.4g}, "
                             "transmittance {}",
                             place_of(e.position), text_of(e.direction), e.edges, text_of(e.radiance),
                             e.pdf_solid_angle, e.delta ? "" : "/sr", e.mis_weight, text_of(e.transmittance)));
    return indent;
  }
  int write(const happening::VplConnection& c) {
    const int indent = path_indent() + 1;
    line(indent, fmt::format("VPL {} at {}, {}, vertex {} of its light path: distance {:.6g}, {} edges", c.vpl,
                             text_of(c.position), c.material ? material(*c.material) : "diffuse", c.vertex, c.distance,
                             c.edges));
    const std::string weight = c.candidate_weight
                                   ? fmt::format("{:.6g} (as candidate {:.6g}, as drawn {:.6g})", c.weight,
                                                 *c.candidate_weight, c.weight / *c.candidate_weight)
                                   : fmt::format("{:.6g} (1 / {:.6g})", c.weight, 1 / c.weight);
    line(indent + 1, fmt::format("unshadowed {}, of which bounding left {:.4g}; transmittance {}, weight {}",
                                 text_of(c.unshadowed), c.bounded_weight, text_of(c.transmittance), weight));
    return indent;
  }
  int write(const happening::Group& group) {
    line(0, fmt::format("group of pixel {},{}: one of {} that hold the pixel, whose mean is the sample", group.base.x,
                        group.base.y, group.groups));
    return 0;
  }

  void write_value(const PathLog::Entry& entry, int indent) {
    ray_value_ += entry.value;
    std::string text = "+ " + text_of(entry.value);
    if (entry.part) text += fmt::format(" {}", k_part_names[static_cast<std::size_t>(*entry.part)]);
    if (luminance(entry.value) > 0 && luminance(entry.value) == largest_) text += " <- largest";
    line(indent, text);
  }
  void end_ray() {
    if (in_ray_) line(k_ray_indent + 1, "= " + text_of(ray_value_));
    ray_value_ = Rgb(), in_ray_ = false;
  }

  std::string material(std::uint32_t index) const {
    if (index >= scene_.material_names().size()) return fmt::format("material {}", index);
    const MaterialName& name = scene_.material_names()[index];
    return fmt::format("material {} \"{}\" ({})", index, name.id, name.kind);
  }

  const Scene& scene_;
  float largest_;
  std::string text_;
  bool in_ray_ = false;
  Rgb ray_value_;
};

}  // namespace

Replay replay_sample(const Scene& scene, const MethodPlan& method, const RenderSettings& settings, Pixel pixel,
                     std::uint32_t pass, bool parts) {
  const Resolution resolution = scene.camera().resolution();
  if (!resolution.contains(pixel))
    throw_input_error("--replay", fmt::format("pixel {},{} is outside of the image: X must be 0 to {}, Y 0 to {}",
                                              pixel.x, pixel.y, resolution.width - 1, resolution.height - 1));
  Replay replay{pixel, {}, {}};
  const std::unique_ptr<Integrator> integrator = make_integrator(method);
  integrator->prepare(scene, settings);
  integrator->set_probe({pixel, pass, &replay.log});
  Film film(resolution, {.gradients = integrator->traits().gradients, .parts = parts});
  integrator->render_pass(pass, film);
  replay.recorded = film.primal()[pixel];
  return replay;
}

std::string to_text(const Replay& replay, const Scene& scene) {
  const DebugSample& sample = replay.log.sample();
  Writer writer(scene, sample.contribution.luminance);
  writer.line(0, fmt::format("pixel {},{}, pass {}", replay.pixel.x, replay.pixel.y, sample.pass));
  double sum[3] = {};
  for (const PathLog::Entry& entry : replay.log.entries()) {
    writer.write(entry);
    for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(entry.value[c]);
  }
  writer.line(0, fmt::format("sum of the contributions ({:.6g}, {:.6g}, {:.6g}), largest luminance {:.6g}", sum[0],
                             sum[1], sum[2], sample.contribution.luminance));
  writer.line(0, fmt::format("cost: {} rays, cut size {:.6g}, {:.6g} node evaluations", sample.rays, sample.cut_size,
                             sample.node_evaluations));
  writer.line(0, "value " + exact_text_of(sample.value));
  return writer.text();
}

}  // namespace gradslc
