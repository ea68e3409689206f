#include "drivers/storage/printable.h"

#include <gtest/gtest.h>

namespace drivers {
namespace {

TEST(Printable, ReplacesWhatControlsATerminal) {
  EXPECT_EQ(printable("a\x1b[31mb\r\n\x7f"), "a?[31mb???");
  EXPECT_EQ(printable("a\xC2\x9B"
                      "31mb"),
            "a?31mb")
      << "the one-character form of ESC [";
}

TEST(Printable, ReplacesMarksOfDirectionAndHiddenCharacters) {
  EXPECT_EQ(printable("x\xE2\x80\xAEgpj.exe"), "x?gpj.exe");
  EXPECT_EQ(printable("a\xE2\x81\xA6"
                      "b\xE2\x80\x8B"
                      "c\xEF\xBB\xBF"
                      "d\xD8\x9C"),
            "a?b?c?d?");
  EXPECT_EQ(printable("\xF3\xA0\x81\x81"), "?");
}

TEST(Printable, KeepsOrdinaryTextOfAnyLanguage) {
  for (const char* text : {"mm^2/Hz", "Brücke – Süd", "桥梁", "μm ± 3 σ", "🛸"}) EXPECT_EQ(printable(text), text);
}

TEST(Printable, ReplacesBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("a\xFF"
                      "b\xC3"),
            "a?b?");
}

TEST(Printable, CutsBetweenCharacters) {
  EXPECT_EQ(printable("üüü", 3), "ü...");
  EXPECT_EQ(printable("üüü", 6), "üüü");
}

TEST(Printable, LinesStayAndCannotBeginAsAnotherMessage) {
  EXPECT_EQ(printable_lines("one\ntwo\x1b\n[error] three\n", "  "), "one\n  two?\n  [error] three\n");
}

}  // namespace
}  // namespace drivers
