#include "epafi/deck/StepCards.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>

namespace epafi::deck {
namespace {

/// Takes those of the fields that are known, and passes over the others.
void addPrint(Reading& reading, const Card& card, Print print, std::initializer_list<const char*> known) {
  const std::string totals = card.value("TOTALS");
  print.totals = totals == "YES"    ? Print::Totals::beside
                 : totals == "ONLY" ? Print::Totals::alone
                                    : Print::Totals::none;
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    for (int i = 0; i < fields.size(); ++i) {
      const std::string field = squeezed(fields[i]);
      if (std::find(known.begin(), known.end(), field) != known.end())
        print.fields.push_back(field);
      else if (!field.empty())
        reading.ignore(card.shown + ' ' + shortened(field), line.place());
    }
  }
  print.place = card.place;
  reading.step().prints.push_back(std::move(print));
}

} // namespace

void readNodePrint(Reading& reading, const Card& card) {
  if (!reading.isInStep || !card.has("NSET"))
    return reading.ignore(card.shown, card.place);
  addPrint(reading, card, {.set = reading.nodeSet(card, "NSET")}, {"U", "RF"});
}

void readElementPrint(Reading& reading, const Card& card) {
  if (!reading.isInStep || !card.has("ELSET"))
    return reading.ignore(card.shown, card.place);
  addPrint(reading, card, {.of = Print::Of::elements, .set = reading.elementSet(card, "ELSET")},
           {"S", "E", "ME", "ENER"});
}

void readSectionPrint(Reading& reading, const Card& card) {
  if (!reading.isInStep)
    return reading.ignore(card.shown, card.place);
  const std::string surface = card.required("SURFACE");
  reading.refer(card, card.place, Reading::Reference::To::surface, surface);
  addPrint(reading, card, {.of = Print::Of::section, .set = surface}, {"SOF", "SOM", "SOAREA"});
}

void readContactPrint(Reading& reading, const Card& card) {
  if (!reading.isInStep)
    return reading.ignore(card.shown, card.place);
  addPrint(reading, card,
           {.of = Print::Of::contact, .dependent = card.value("SLAVE"), .independent = card.value("MASTER")},
           {"CDIS", "CSTR", "CF"});
}

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

} // namespace epafi::deck
