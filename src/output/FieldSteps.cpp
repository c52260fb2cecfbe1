#include "epafi/output/FieldSteps.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/output/SafeNames.hpp"
#include "epafi/output/internal/Hdf5Handle.hpp"

#include <cmath>
#include <optional>
#include <span>
#include <string>

namespace epafi::output {
namespace {

/// An attribute of a group, if there is such a file, group and attribute.
std::optional<double> numberOf(hid_t file, const std::string& group, const char* name) {
  const Handle attribute(file < 0 ? -1 : H5Aopen_by_name(file, group.c_str(), name, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  const Handle extent(attribute < 0 ? -1 : H5Aget_space(attribute), H5Sclose);
  double number = 0;
  if (extent < 0 || H5Sget_simple_extent_npoints(extent) != 1 ||
      H5Aread(attribute, H5T_NATIVE_DOUBLE, &number) < 0)
    return std::nullopt;
  return number;
}

/// Of their groups.
template <class Steps>
std::vector<std::string> namesOf(const Steps& steps) {
  std::vector<std::string> names;
  for (const auto& step : steps)
    names.push_back(step.name);
  return safeNames(names);
}

} // namespace

std::vector<FieldStep> stepsIn(const std::filesystem::path& file,
                               const std::vector<simulation::StepResult>& steps, const Comm& comm) {
  constexpr double roundOff = 1e-9; // of a sum of two
  const std::vector<std::string> groups = namesOf(steps);
  std::vector<int> isThere(steps.size(), 0);
  if (comm.getRank() == 0) {
    const QuietHdf5 quiet;
    const Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const std::string group = "/steps/" + groups[k];
      const std::optional<double> number = numberOf(opened, group, "number"),
                                  energy = numberOf(opened, group, "energy");
      isThere[k] = number == static_cast<double>(k + 1) && energy &&
                   std::abs(*energy - (steps[k].strainEnergy - steps[k].loadWork)) <=
                       roundOff * (std::abs(steps[k].strainEnergy) + std::abs(steps[k].loadWork));
    }
  }
  sumOverRanks(comm, std::span(isThere));
  std::vector<FieldStep> found;
  std::vector<std::string> theirs;
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (isThere[k] > 0) {
      found.push_back({steps[k].name, static_cast<int>(k + 1)});
      theirs.push_back(groups[k]);
    }
  return namesOf(found) == theirs ? found : std::vector<FieldStep>();
}

} // namespace epafi::output
