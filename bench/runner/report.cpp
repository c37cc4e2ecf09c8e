#include "runner/report.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "crumble/base/file.hpp"
#include "runner/revision.hpp"

namespace crumble::bench {
namespace {

using nlohmann::ordered_json;

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[300];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string text; std::getline(in, text);) {
    if (text.starts_with("model name")) return text.substr(text.find(':') + 2);
  }
  return "unknown";
}

ordered_json machine() {
  double load[1] = {0};
  getloadavg(load, 1);
  return {{"version", CRUMBLE_VERSION},
          {"revision", kRevision},
          {"compiler", CRUMBLE_COMPILER},
          {"processor", processor()},
          {"cores", std::thread::hardware_concurrency()},
          {"load", load[0]}};
}

// Nanoseconds are enough, and files that differ by noise only are shorter.
double rounded(double microseconds) {
  return std::round(microseconds * 1e3) / 1e3;
}

ordered_json to_json(const Percentiles& p) {
  return {{"p50", rounded(p.p50)}, {"p99", rounded(p.p99)}, {"p99_9", rounded(p.p99_9)}, {"max", rounded(p.max)}};
}

ordered_json to_json(const StepProfile& stages) {
  return {{"move_tool", rounded(stages.move_tool)},
          {"find_contacts", rounded(stages.find_contacts)},
          {"project_contacts", rounded(stages.project_contacts)},
          {"touch_fragments", rounded(stages.touch_fragments)},
          {"solve_network", rounded(stages.solve_network)},
          {"cut_springs", rounded(stages.cut_springs)},
          {"sum_reaction", rounded(stages.sum_reaction)},
          {"finish_step", rounded(stages.finish_step)}};
}

ordered_json to_json(const Row& row) {
  ordered_json json{{"springs", row.springs},
                    {"wanted_springs", row.wanted_springs},
                    {"nodes", row.nodes},
                    {"structure", row.structure},
                    {"stick", row.stick},
                    {"lattice", row.lattice},
                    {"precision", row.precision},
                    {"kernel", row.kernel},
                    {"threads", row.threads},
                    {"network_us", rounded(row.network)},
                    {"network_wall_us", rounded(row.network_wall)},
                    {"plain_us", rounded(row.plain)},
                    {"ratio", rounded(row.ratio)}};
  if (row.plain_as_it_comes) json["plain_shuffled_us"] = rounded(*row.plain_as_it_comes);
  json["bullet_us"] = row.bullet ? ordered_json(rounded(*row.bullet)) : ordered_json("not installed");
  if (row.bullet_ratio) json["bullet_ratio"] = rounded(*row.bullet_ratio);
  json["difference_from_plain_m"] = row.difference_from_plain;
  json["steps"] = row.steps;
  json["step_us"] = to_json(row.step_cpu);
  json["step_raw_us"] = to_json(row.step_raw);
  json["control_raw_us"] = to_json(row.control_raw);
  json["step_wall_us"] = to_json(row.step_wall);
  json["control_wall_us"] = to_json(row.control_wall);
  json["stages_us"] = to_json(row.stages);
  json["step_ratio"] = rounded(row.step_cpu.p50 / row.network);
  json["cuts"] = row.cuts, json["cuts_before"] = row.cuts_before, json["contacts"] = row.contacts;
  json["hash"] = line("%016llx", static_cast<unsigned long long>(row.hash));
  const auto springs = static_cast<double>(row.springs);
  json["layout"] = {{"lane_use", springs / static_cast<double>(row.layout.lanes)},
                    {"share_in_segments", static_cast<double>(row.layout.springs_in_segments) / springs},
                    {"segments", row.layout.segments},
                    {"batches", row.layout.batches},
                    {"partitions", row.layout.partitions},
                    {"sorted", row.layout.sorted}};
  return json;
}

std::string text_of(const ordered_json& row, const char* key) {
  return row.at(key).get<std::string>();
}
double number(const ordered_json& row, const char* key) {
  return row.at(key).get<double>();
}

std::string head(const ordered_json& results) {
  return line("%s, %d cores; crumble %s at %s, %s; load %.1f\n", text_of(results, "processor").c_str(),
              results.at("cores").get<int>(), text_of(results, "version").c_str(), text_of(results, "revision").c_str(),
              text_of(results, "compiler").c_str(), number(results, "load"));
}

std::string case_of(const ordered_json& row) {
  return line("%8.0f %-9s%-8s %-8s %2.0f", number(row, "springs"), text_of(row, "structure").c_str(),
              text_of(row, "precision").c_str(), text_of(row, "kernel").c_str(), number(row, "threads"));
}
constexpr const char* kCaseHead = " springs structure prec.   kernel   th";

std::string table_row(const ordered_json& row) {
  const ordered_json &cpu = row.at("step_us"), &bullet = row.at("bullet_us"), &layout = row.at("layout");
  std::string text = case_of(row);
  text += line(" |%9.1f %9.1f %6.2f", number(row, "network_us"), number(row, "plain_us"), number(row, "ratio"));
  text += bullet.is_number() ? line(" %9.1f", bullet.get<double>()) : std::string("      none");
  text += line(" |%9.1f %9.1f %9.1f %9.1f %5.2f", number(cpu, "p50"), number(cpu, "p99"), number(cpu, "p99_9"),
               number(cpu, "max"), number(row, "step_ratio"));
  text += line(" |%6.0f %5.2f %5.2f %3.0f  %s\n", number(row, "cuts"), number(layout, "lane_use"),
               number(layout, "share_in_segments"), number(layout, "partitions"), text_of(row, "hash").c_str());
  return text;
}

// Runs `work` on results that may not have the form they ought to have.
template <class Work>
std::string guarded(const std::string& name, Work&& work) {
  try {
    return work();
  } catch (const nlohmann::json::exception& error) {
    throw Error(Code::format, "'" + name + "' holds no benchmark results: " + error.what());
  }
}

bool same_case(const ordered_json& a, const ordered_json& b) {
  for (const char* key : {"wanted_springs", "structure", "stick", "precision", "kernel", "threads"}) {
    if (a.at(key) != b.at(key)) return false;
  }
  return true;
}

std::string comparison(const ordered_json& a, const ordered_json& b) {
  std::string text = case_of(b);
  for (const auto& [key, part] : {std::pair{"network_us", ""}, {"step_us", "p50"}, {"step_us", "p99_9"}}) {
    const double before = *part ? number(a.at(key), part) : number(a, key);
    const double after = *part ? number(b.at(key), part) : number(b, key);
    text += line(" |%9.1f %9.1f %6.2f", before, after, after / before);
  }
  text += line(" |%6.2f %6.2f", number(a, "ratio"), number(b, "ratio"));
  const bool same_window = a.at("steps") == b.at("steps");
  return text + (!same_window ? "  other steps\n" : a.at("hash") == b.at("hash") ? "  same\n" : "  other bits\n");
}

}  // namespace

std::string to_json(std::span<const Row> rows) {
  ordered_json results = machine();
  results["rows"] = ordered_json::array();
  for (const Row& row : rows) results["rows"].push_back(to_json(row));
  return results.dump(1) + "\n";
}

std::string to_table(const std::string& json, const std::string& name) {
  return guarded(name, [&] {
    const ordered_json results = ordered_json::parse(json);
    std::string text = head(results);
    text += std::string(kCaseHead) +
            " |  network     plain  ratio    bullet |  step p50       p99     p99.9       max" +
            "  /net |  cuts lanes  segm  pt  hash\n";
    for (const ordered_json& row : results.at("rows")) text += table_row(row);
    return text;
  });
}

std::string compare(const std::filesystem::path& before, const std::filesystem::path& after) {
  const std::string old_text = read_text(before), new_text = read_text(after);
  const auto parse = [](const std::string& text, const std::string& name) {
    ordered_json results;
    guarded(name, [&] { return results = ordered_json::parse(text), head(results); });
    return results;
  };
  const ordered_json a = parse(old_text, before), b = parse(new_text, after);
  return guarded(after, [&] {
    std::string text = "A " + head(a) + "B " + head(b) + kCaseHead;
    text +=
        " |network A         B    B/A | step p50 A        B    B/A | p99.9 A          B    B/A | ratio A     B  bits\n";
    for (const ordered_json& row : b.at("rows")) {
      for (const ordered_json& old : a.at("rows")) {
        if (same_case(old, row)) text += comparison(old, row);
      }
    }
    return text;
  });
}

}  // namespace crumble::bench
