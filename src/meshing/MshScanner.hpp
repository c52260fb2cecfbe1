#pragma once

/// Words and numbers of a mesh file of Gmsh, in text or binary, and none beyond its end.

#include "epafi/base/Types.hpp"

#include <string>
#include <string_view>

namespace epafi::meshing {

/// Reads from the front to the end. Every function throws InputError that names the file and the place in it
/// (line, or byte of a binary file) if what is asked for is not there.
class MshScanner {
public:
  /// \param name  the file's name, for errors
  MshScanner(std::string name, std::string text) : name_(std::move(name)), text_(std::move(text)) {}

  /// Of the numbers from here on. Text is what a file begins with.
  void setBinary(bool isBinary) { isBinary_ = isBinary; }
  [[nodiscard]] bool isBinary() const { return isBinary_; }

  /// The next line that is not blank, without the blanks around it; empty at the end of the file.
  std::string_view line();
  /// Behind the next place where the text stands; false, and nothing done, if there is none.
  bool skipBehind(std::string_view text);

  int integer();         ///< binary: four bytes
  GlobalOrdinal tag();   ///< binary: four bytes; as text it may be larger, as Gmsh's own numbers are
  GlobalOrdinal whole(); ///< binary: eight bytes without sign, not above the largest GlobalOrdinal
  double real();
  /// How many things follow, a whole(): no more than the rest of the file can hold.
  /// \param bytesEach, numbersEach  what a thing takes at least, in binary and (two letters a number) in text
  LocalOrdinal count(const std::string& things, std::size_t bytesEach, std::size_t numbersEach);
  /// The same from a line of its own, which is text in binary files, too.
  LocalOrdinal countInLine(const std::string& things, std::size_t bytesEach, std::size_t numbersEach);

  /// Throws 'The mesh file "name", line 3: what', where the last thing was read.
  [[noreturn]] void refuse(const std::string& what) const;

private:
  std::string_view word();
  template <class T>
  T fromText(std::string_view text, const char* kind) const;
  LocalOrdinal checkedCount(GlobalOrdinal number, const std::string& things, std::size_t bytesEach,
                            std::size_t numbersEach) const;
  template <class T>
  T fromBytes();

  std::string name_, text_;
  std::size_t next_ = 0; ///< place of what is read next
  std::size_t last_ = 0; ///< and of what was read last
  bool isBinary_ = false;
};

} // namespace epafi::meshing
