#pragma once

/// Keyword lines of a deck with their parameters and the data lines behind each, before anything is known of
/// what they mean.

#include "epafi/deck/Deck.hpp"

#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace epafi::deck {

/// A data line, without the blanks around it. The text and the file's name are the Cards'.
struct Line {
  std::string_view text;
  const std::string* file = nullptr;
  int number = 0;

  [[nodiscard]] Place place() const { return {*file, number}; }
};

/// `NAME=value`, or `NAME` alone.
struct Parameter {
  std::string name;  ///< upper case, without blanks
  std::string value; ///< likewise, but for the name of an included file
};

struct Card {
  std::string keyword; ///< upper case, without blanks and star: HEATTRANSFER
  std::string shown;   ///< as sentences name it: *HEAT TRANSFER
  Place place;
  std::vector<Parameter> parameters;
  std::vector<Line> data;

  [[nodiscard]] bool has(std::string_view parameter) const { return find(parameter) != nullptr; }
  [[nodiscard]] std::string value(std::string_view parameter) const; ///< empty if there is none
  [[nodiscard]] std::string required(std::string_view parameter) const;
  /// The parameter's number, if it is there.
  [[nodiscard]] std::optional<double> number(std::string_view parameter) const;
  /// Throws InputError "beam.inp, line 12: *PLASTIC: what".
  [[noreturn]] void refuse(const std::string& what) const { refuseAt(place, what); }
  [[noreturn]] void refuseAt(const Place& where, const std::string& what) const;

private:
  [[nodiscard]] const Parameter* find(std::string_view parameter) const;
};

/// All cards of a deck and its included files, in order.
class Cards {
public:
  /// The text of an included file.
  using Include = std::function<std::string(const std::string& name, const Card& card)>;

  /// \throws InputError  if there is no keyword, of includes that go in circles, or whatever `include` throws
  Cards(const std::string& name, std::string text, Include include);

  [[nodiscard]] const std::vector<Card>& list() const { return cards_; }
  /// Where there is something before the first keyword that is no comment.
  [[nodiscard]] const std::optional<Place>& textInFront() const { return textInFront_; }

private:
  void read(const std::string& name, std::string text);
  void add(const std::string& line, const Place& place);
  void includeFile(const Card& card);

  Include include_;
  std::deque<std::string> texts_, names_; ///< where they stand, they stay
  std::vector<std::string> open_;
  std::vector<Card> cards_;
  std::optional<Place> textInFront_;
};

std::string_view withoutBlanks(std::string_view text); ///< at both ends
/// Upper case, without any blanks and without quotes at the ends.
std::string squeezed(std::string_view text);

} // namespace epafi::deck
