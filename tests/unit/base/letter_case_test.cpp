#include "engine/base/letter_case.hpp"

#include <doctest/doctest.h>

#include "engine/base/utf8.hpp"

namespace abbe {

TEST_CASE("letters have one case: ASCII, Latin, Greek and Cyrillic") {
  CHECK(upper("az_AZ-09[`{") == "AZ_AZ-09[`{");
  CHECK(upper("äöüàéñøþÿ÷ß") == "ÄÖÜÀÉÑØÞŸ÷ß");
  CHECK(upper("āĺžşœŋſ") == "ĀĹŽŞŒŊS");
  CHECK(upper("ΐαβγςσωάέήίόύώϊ") == "ΐΑΒΓΣΣΩΆΈΉΊΌΎΏΪ");
  CHECK(upper("абяёђџѡґӂӏӱ") == "АБЯЁЂЏѠҐӁӀӰ");
  CHECK(upper("İı") == "İı");  // the two letters i of Turkish are no case of i
  CHECK(upper("中文€") == "中文€");
}

TEST_CASE("capitals stay what they are, and no letter has two") {
  for (char32_t c = 0; c < 0x600; ++c) {
    std::string letter;
    append_utf8(letter, c);
    CHECK(upper(upper(letter)) == upper(letter));
  }
}

TEST_CASE("small letters are those of the capitals") {
  CHECK(lower("AZ_az-09[`{") == "az_az-09[`{");
  CHECK(lower("ÄÖÜŸ×ĀŽΣΜΏДЏӀ") == "äöüÿ×āžσμώдџӏ");
  for (char32_t c = 0; c < 0x600; ++c) {
    std::string letter;
    append_utf8(letter, c);
    CHECK(lower(lower(letter)) == lower(letter));
    CHECK(upper(lower(letter)) == upper(letter));
  }
}

TEST_CASE("labels of a file in Latin-1 and of one in UTF-8 are the same") {
  CHECK(same_label("B\xF6re", "BÖRE"));
  CHECK(same_label("b\xD6re", "böre"));
  CHECK_FALSE(same_label("böre", "bore"));
  CHECK_FALSE(same_label("bö", "böre"));
}

TEST_CASE("characters of UTF-8 and bytes that are none") {
  CHECK(utf8_character("é", 0).code == 0xE9);
  CHECK(utf8_character("€", 0).bytes == 3);
  CHECK(utf8_character("\xF0\x9F\x98\x80", 0).code == 0x1F600);
  for (const char* none : {"\x80", "\xC0\x80", "\xC3", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xFF"}) {
    CHECK(utf8_character(none, 0).bytes == 0);
    CHECK(character_at(none, 0).bytes == 1);
  }
  CHECK(count_characters("a\xF6€é") == 4);
}

}  // namespace abbe
