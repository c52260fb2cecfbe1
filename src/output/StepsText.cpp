#include "epafi/output/StepsText.hpp"

#include "epafi/base/Errors.hpp"

#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

namespace epafi::output {
namespace {

using simulation::ContactResult, simulation::FrictionFeedback, simulation::FrictionResult,
    simulation::HeldSupport, simulation::JointBalance, simulation::NodeSlip, simulation::PreloadResult,
    simulation::RunStatus, simulation::StepResult, simulation::StepsDone, simulation::SupportResult,
    simulation::TieResult, simulation::HoldResult;

/// Appends values to a text.
class StepsWriter {
public:
  static constexpr bool reads = false;

  void value(const std::string& text) {
    value(text.size());
    text_.append(text) += '\n';
  }
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void value(Number number) {
    std::array<char, 32> digits{};
    text_.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr) +=
        '\n';
  }
  [[nodiscard]] std::string text() && { return std::move(text_); }

private:
  std::string text_;
};

/// Takes them from there.
class StepsReader {
public:
  static constexpr bool reads = true;

  explicit StepsReader(std::string_view text) : text_(text) {}
  void value(std::string& text) {
    std::size_t length = 0;
    value(length);
    if (length > text_.size())
      refuse();
    text = text_.substr(0, length);
    text_.remove_prefix(length);
    endLine();
  }
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void value(Number& number) {
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), number);
    if (error != std::errc())
      refuse();
    text_.remove_prefix(end - text_.data());
    endLine();
  }
  void requireEnd() const { ///< of the text
    if (!text_.empty())
      refuse();
  }
  [[noreturn]] static void refuse() { throw InputError("holds load steps that cannot be read"); }

private:
  void endLine() {
    if (!text_.starts_with('\n'))
      refuse();
    text_.remove_prefix(1);
  }

  std::string_view text_;
};

/// Writes or reads values, one field after the other.
template <class File>
class Passage {
public:
  explicit Passage(File file) : file_(std::move(file)) {}
  [[nodiscard]] File& file() { return file_; }

  template <class... Values>
  void operator()(Values&... values) {
    (pass(values), ...);
  }

private:
  template <class Value>
  void pass(Value& value) {
    file_.value(value);
  }
  template <class Value, std::size_t size>
  void pass(std::array<Value, size>& values) {
    for (Value& value : values)
      pass(value);
  }
  template <class Value>
  void pass(std::optional<Value>& value) {
    int isThere = value ? 1 : 0;
    pass(isThere);
    if (isThere != 0)
      pass(value ? *value : value.emplace());
  }
  template <class Value>
  void pass(std::vector<Value>& values) {
    std::size_t number = values.size();
    pass(number);
    for (std::size_t k = 0; k < number; ++k)
      pass(File::reads ? values.emplace_back() : values[k]);
  }
  void pass(std::map<GlobalOrdinal, Vector3>& values) {
    std::vector<GlobalOrdinal> keys;
    for (const auto& [key, value] : values)
      keys.push_back(key);
    pass(keys);
    for (const GlobalOrdinal key : keys)
      pass(values[key]);
  }
  void pass(FrictionResult& friction) {
    (*this)(friction.tangentialForce, friction.moment, friction.tangentialMoment, friction.centre,
            friction.centreMoment, friction.centreTangential, friction.stickArea, friction.slipArea,
            friction.openArea, friction.dissipation, friction.largestSlip);
  }
  void pass(JointBalance& balance) { (*this)(balance.coupling, balance.force, balance.moment); }
  void pass(ContactResult& contact) {
    (*this)(contact.name, contact.candidates, contact.activeNodes, contact.force, contact.resultant,
            contact.largestPressure, contact.area, contact.penetration, contact.numBent, contact.note,
            contact.balance, contact.friction);
  }
  void pass(SupportResult& support) { (*this)(support.body, support.name, support.force, support.moment); }
  void pass(PreloadResult& preload) { (*this)(preload.name, preload.force, preload.shortening); }
  void pass(TieResult& tie) {
    (*this)(tie.name, tie.nodes, tie.resultant, tie.largestTraction, tie.note, tie.balance);
  }
  void pass(HoldResult& hold) { (*this)(hold.motion, hold.force, hold.place); }
  void pass(StepResult& step) {
    (*this)(step.name, step.multiplications, step.strainEnergy, step.loadWork, step.dissipation,
            step.contacts, step.supports, step.preloads, step.ties, step.holds, step.doubts, step.reason,
            step.feedback, step.relativeError);
    step.status = RunStatus::converged; // others are not done
  }
  void pass(FrictionFeedback& feedback) { (*this)(feedback.factor, feedback.multiplications); }
  void pass(NodeSlip& node) { (*this)(node.contact, node.body, node.node, node.slip); }
  void pass(HeldSupport& support) { (*this)(support.body, support.name, support.displacements); }

  File file_;
};

/// All of it.
template <class File>
void pass(Passage<File>& passage, StepsDone& done) {
  passage(done.marks, done.meshes, done.results, done.slip, done.held);
}

} // namespace

std::string stepsText(const StepsDone& done) {
  Passage passage{StepsWriter()};
  StepsDone copy = done;
  pass(passage, copy);
  return std::move(passage.file()).text();
}

StepsDone stepsOf(std::string_view text) {
  Passage passage{StepsReader(text)};
  StepsDone done;
  pass(passage, done);
  passage.file().requireEnd();
  if (done.results.empty()) // then there is nothing to go on from
    StepsReader::refuse();
  return done;
}

} // namespace epafi::output
