// Programs by chance, for the fuzz tests: from the grammar of the statement tables, and by damage
// to programs that exist. All chance comes from a std::mt19937, whose sequence the standard fixes,
// so a seed names the same program everywhere.
#pragma once

#include <random>
#include <string>
#include <vector>

namespace abbe::fuzz {

/// A program whose every statement has a form that its signature allows, with labels that mostly
/// exist and numbers that mostly make sense: it reaches beyond the parser.
std::string random_program(std::mt19937&);

/// `text` with a few edits: bytes, words, whole lines changed, moved, repeated, cut, spliced with
/// lines of `other`.
std::string damaged(std::string text, const std::string& other, std::mt19937&);

/// The programs of tests/lang and examples below `root`.
std::vector<std::string> existing_programs(const std::string& root);

}  // namespace abbe::fuzz
