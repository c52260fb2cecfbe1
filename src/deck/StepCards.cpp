#include "epafi/deck/StepCards.hpp"

#include "epafi/base/Errors.hpp"

namespace epafi::deck {
namespace {

/// Of a print's card, all but what it is of. FREQUENCY=0 prints nothing.
void addPrint(Reading& reading, const Card& card, Print::Of of, const std::string& set) {
  Print print{card.place, of, set, {}, card.value("GLOBAL") == "YES", false, false};
  const std::string totals = card.value("TOTALS");
  if (!totals.empty() && totals != "YES" && totals != "ONLY" && totals != "NO")
    card.refuse("TOTALS=" + shortened(totals) + " is none of YES, ONLY and NO");
  print.onlyTotals = totals == "ONLY";
  print.totals = print.onlyTotals || totals == "YES";
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    for (int i = 0; i < fields.size(); ++i)
      if (fields.has(i))
        print.quantities.push_back(fields.name(i, "a quantity"));
  }
  if (card.number("FREQUENCY").value_or(1) != 0)
    reading.step().prints.push_back(std::move(print));
}

} // namespace

void readHeading(Reading& reading, const Card& card) {
  if (reading.deck.title.empty() && !card.data.empty())
    reading.deck.title = card.data[0].text;
}

void readStep(Reading& reading, const Card& card) {
  if (reading.isInStep)
    card.refuse("the step of " + text(reading.step().place) +
                " has not ended; put *END STEP before this one");
  const std::string nonlinear = card.value("NLGEOM");
  if (card.has("NLGEOM"))
    reading.isNonlinear = nonlinear != "NO"; // and so are the steps that follow
  reading.isInStep = true;
  reading.hasProcedure = false;
  reading.deck.steps.emplace_back();
  reading.step().place = card.place;
  reading.step().isPerturbation = card.has("PERTURBATION");
  reading.step().isNonlinear = reading.isNonlinear && !card.has("PERTURBATION");
}

void readStatic(Reading& reading, const Card& card) {
  if (reading.hasProcedure)
    card.refuse("the step has one already");
  reading.hasProcedure = true;
  if (card.has("SOLVER"))
    reading.ignore(card.shown + ", SOLVER", card.place);
  if (card.data.size() > 1)
    card.refuseAt(card.data[1].place(), "it has one line, of times; take this one out");
  if (card.data.empty())
    return;
  const Fields fields(card, card.data[0]);
  for (int i = 0; i < fields.size(); ++i)
    if (fields.realOr(i, "a time", 0) < 0)
      fields.refuse("times should not be negative");
  reading.step().period = fields.realOr(1, "the step's period", 1);
  if (reading.step().period == 0)
    fields.refuse("the step's period, its second number, should be positive");
}

void readEndStep(Reading& reading, const Card& card) {
  if (!reading.hasProcedure)
    card.refuse("the step of " + text(reading.step().place) + " has no *STATIC; add it");
  if (reading.awaitsFriction)
    card.refuse("the step has a *CHANGE FRICTION without the *FRICTION that belongs behind it");
  reading.isInStep = false;
}

void readNodePrint(Reading& reading, const Card& card) {
  addPrint(reading, card, Print::Of::nodes, reading.nodeSet(card, "NSET"));
}

void readElementPrint(Reading& reading, const Card& card) {
  addPrint(reading, card, Print::Of::elements, reading.elementSet(card, "ELSET"));
}

void readContactPrint(Reading& reading, const Card& card) {
  std::string set;
  for (const char* const parameter : {"SLAVE", "NSET", "SET"})
    if (set.empty())
      set = card.value(parameter);
  for (const char* const parameter : {"SLAVE", "MASTER"})
    reading.refer(card, card.place, Reading::Reference::To::surface, card.value(parameter));
  addPrint(reading, card, Print::Of::contact, set);
}

void readSectionPrint(Reading& reading, const Card& card) {
  const std::string surface = card.required("SURFACE");
  reading.refer(card, card.place, Reading::Reference::To::surface, surface);
  addPrint(reading, card, Print::Of::section, surface);
}

} // namespace epafi::deck
