#include "app/page/page_template.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/json.h"

#include <gtest/gtest.h>

#include <array>
#include <fstream>

namespace tribound
{
namespace
{

class PageTemplateFile : public ::testing::Test
{
 protected:
  void SetUp() override
  {
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_);
  }

  const std::filesystem::path directory_ =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("page_template_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST(PageTemplate, NoStringEndsTheScript)
{
  EXPECT_EQ(app::script_safe(R"("</script><!-- & > \u00e4")"), R"("\u003c/script>\u003c!-- & > \u00e4")");
}

TEST_F(PageTemplateFile, TakesTheDataInThePlaceOfTheMarker)
{
  const std::filesystem::path file = directory_ / "template.html";
  std::ofstream(file) << "<p>" << app::page_data_marker << "</p>";
  const app::PageTemplate page(file);
  EXPECT_FALSE(page.empty());
  page.write(directory_ / "page.html", "the-id", io::Json::array({"<", 2}));
  EXPECT_EQ(io::read_text(directory_ / "page.html"),
            R"(<p><script type="application/json" id="the-id">["\u003c",2]</script></p>)");
}

TEST_F(PageTemplateFile, IsEmptyWithoutAFileOrAPlaceForData)
{
  std::ofstream(directory_ / "other.html") << "<html>no place for data</html>";
  for (const auto& path : {std::filesystem::path{}, directory_ / "missing.html", directory_ / "other.html"})
  {
    const app::PageTemplate page(path);
    EXPECT_TRUE(page.empty());
    page.write(directory_ / "page.html", "id", {});
  }
  EXPECT_FALSE(std::filesystem::exists(directory_ / "page.html"));
}

TEST_F(PageTemplateFile, NamesTheFilesThatAreThere)
{
  std::ofstream(directory_ / "b.csv") << "";
  std::ofstream(directory_ / "a.csv") << "";
  EXPECT_EQ(app::files_json(directory_, std::array<std::string, 3>{"b.csv", "missing.csv", "a.csv"}),
            io::Json::array({"b.csv", "a.csv"}));
}

}  // namespace
}  // namespace tribound
