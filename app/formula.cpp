#include "app/formula.hpp"

#include <muParser.h>

#include <cctype>
#include <numbers>

namespace greenwater {
namespace {

/// muParser takes `x = 3` as an assignment to x. Returns the place of such a sign, or npos.
std::size_t find_assignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool doubled = i + 1 < text.size() && text[i + 1] == '=';
    const bool compares = i > 0 && (text[i - 1] == '<' || text[i - 1] == '>' || text[i - 1] == '!');
    if (!doubled && !compares) return i;
    if (doubled) ++i;
  }
  return std::string::npos;
}

[[noreturn]] void refuse_formula(const Place& place, const std::string& text, std::size_t position,
                                 const std::string& why) {
  const std::size_t shown = std::min(position, text.size());
  refuse(place, "formula \"", text, "\", character ", shown + 1, ": ", why,
         "; variables are x, y, z [m] and t [s], constants pi and e");
}

}  // namespace

struct Formula::Engine {
  mu::Parser parser;
  double x = 0, y = 0, z = 0, t = 0;

  explicit Engine(const std::string& text) {
    parser.DefineVar("x", &x);
    parser.DefineVar("y", &y);
    parser.DefineVar("z", &z);
    parser.DefineVar("t", &t);
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineConst("e", std::numbers::e);
    parser.SetExpr(text);
  }
};

Formula::Formula(const std::string& text, const Place& place) {
  const std::size_t assignment = find_assignment(text);
  if (assignment != std::string::npos)
    refuse_formula(place, text, assignment, "\"=\" has no meaning here (equality is ==)");
  try {
    engine_ = std::make_unique<Engine>(text);
    engine_->parser.Eval();
  } catch (const mu::Parser::exception_type& fault) {
    const auto position = fault.GetPos();
    std::string why = fault.GetMsg();
    while (!why.empty() && (why.back() == '.' || std::isspace(static_cast<unsigned char>(why.back())) != 0))
      why.pop_back();
    refuse_formula(place, text, position < 0 ? text.size() : static_cast<std::size_t>(position), why);
  }
  if (engine_->parser.GetNumResults() != 1) refuse_formula(place, text, 0, "one value is wanted, not a list");
}

Formula::~Formula() = default;
Formula::Formula(Formula&&) noexcept = default;
Formula& Formula::operator=(Formula&&) noexcept = default;

double Formula::operator()(double x, double y, double z, double t) const {
  engine_->x = x;
  engine_->y = y;
  engine_->z = z;
  engine_->t = t;
  return engine_->parser.Eval();
}

bool Formula::constant() const { return engine_->parser.GetUsedVar().empty(); }

bool Formula::varies_in_time() const { return engine_->parser.GetUsedVar().contains("t"); }

std::array<Formula, 3> compile(const std::array<std::string, 3>& text, const Place& place) {
  return {Formula(text[0], place), Formula(text[1], place), Formula(text[2], place)};
}

bool is_zero(const std::array<Formula, 3>& formulas) {
  for (const Formula& formula : formulas) {
    if (!formula.constant() || formula(0, 0, 0, 0) != 0) return false;
  }
  return true;
}

}  // namespace greenwater
