#pragma once
// One value of a case, checked: kind, unit, range. Each function throws CaseError at the value's place.

#include <string>
#include <vector>

#include "io/section.hpp"

namespace greenwater {

void require_kind(const CaseNode& node, CaseNode::Kind kind, const std::string& key);
const std::vector<CaseNode>& items_of(const CaseNode& node, const std::string& key);

double read_number(const CaseNode& node, const std::string& key, const std::string& unit, const Bounds& range);
std::int64_t read_count(const CaseNode& node, const std::string& key, std::int64_t low);
bool read_flag(const CaseNode& node, const std::string& key);
std::string read_text(const CaseNode& node, const std::string& key);
std::string read_choice(const CaseNode& node, const std::string& key, const Words& allowed);
Point read_point(const CaseNode& node, const std::string& key, const std::string& unit, int dimension);
std::string read_formula(const CaseNode& node, const std::string& key, const std::string& unit);
Formulas read_formulas(const CaseNode& node, const std::string& key, const std::string& unit, int dimension);

}  // namespace greenwater
