# SPDX-License-Identifier: Apache-2.0
"""Reports as a user makes them; every number of the HTML is looked up in the files that it comes from."""
import csv
import json
import re
import unittest
import xml.etree.ElementTree as xml

from support import SOURCE, Case

SVG = "{http://www.w3.org/2000/svg}"
HTML = "{http://www.w3.org/1999/xhtml}"


def cells(page, section):
    """Texts of the tables of a chapter."""
    root = xml.fromstring(page.read_bytes().replace(b"<!DOCTYPE html>\n", b""))
    chapter = [s for s in root.iter(HTML + "section") if s.get("id") == section][0]
    return [t.text or "" for t in chapter.iter(SVG + "text") if t.get("role") == "cell"]


class Report(Case):
    def test_a_survey_without_geometry(self):
        self.good("survey", "job.toml")
        self.good("report", "job.result", "--format", "html,pdf,xlsx")
        result = self.folder / "job.result"
        for name in ("report.html", "report.pdf", "report.xlsx"):
            self.assertGreater((result / name).stat().st_size, 5000, name)
        run = json.loads((result / "run.json").read_text())
        shown = cells(result / "report.html", "inputs")
        for item in run["inputs"]:
            self.assertIn(item["sha256"], shown)
            self.assertIn(str(item["bytes"]), shown)
        sensors = cells(result / "report.html", "control")
        for item in run["results"]["innovations"]:
            self.assertIn(str(item["used"]), sensors)
            self.assertIn("%.3f" % item["mean_nis_per_row"], sensors)

    def test_a_job_makes_its_own(self):
        self.good("survey", "job.toml", "--set", 'report.language="de"', "--set", 'report.operator="A. Meyer"')
        page = (self.folder / "job.result/report.html").read_text()
        self.assertIn("NICHT BEURTEILT", page)
        self.assertIn("A. Meyer", page)
        self.assertNotIn(".new-", page)  # the folder's name is that of the result, not of its making

    def test_a_wrong_format_is_told_before_the_work(self):
        self.refused("survey", "job.toml", "--set", 'report.formats=["doc"]', says=["html, pdf, xlsx"])

    def test_a_plan(self):
        (self.folder / "plan.toml").write_text((SOURCE / "examples/plan/jiang_rlg.toml").read_text())
        self.versine("plan", "plan.toml", "-o", "plan", "--set", "monte_carlo.runs=0")
        self.good("report", "plan")
        with open(self.folder / "plan/run.json") as file:
            results = json.load(file)["results"]
        shown = cells(self.folder / "plan/report.html", "instruments")
        for grade in results["grades"]:
            self.assertIn("%.2f" % grade["sigma_mm"], shown)

    def test_bad_folders(self):
        (self.folder / "empty").mkdir()
        self.refused("report", "empty", says=["empty folder", "versine survey"])
        self.refused("report", "nowhere", says=["no folder"])
        self.good("survey", "job.toml", "-o", "out")
        self.refused("report", "out", "--format", "doc", says=["html, pdf, xlsx"])
        self.refused("report", "out", "--language", "xx", says=["en, de, zh"])
        path = self.folder / "out/run.json"
        path.write_text(path.read_text().replace("versine run 1", "versine run 0"))
        self.refused("report", "out", says=["versine run 0", "run the job again"])


class TrackGeometry(Case):
    """A straight kilometre of another software's trajectory, with a bend in it that is over a limit."""

    def setUp(self):
        super().setUp()
        rows = ["time_s,easting_m,northing_m,height_m,roll_deg,pitch_deg,heading_deg"]
        for k in range(6001):
            s = 0.1 * k
            bump = 0.012 * max(0.0, 1.0 - abs(s - 300.0) / 4.0)
            rows.append("%.2f,%.5f,%.5f,%.5f,0.0,0.0,90.0" % (0.1 * k, 500000.0 + s, 5600000.0, 100.0 + bump))
        (self.folder / "track.csv").write_text("\n".join(rows) + "\n")
        limits = SOURCE.resolve() / "data/limits/en13848-5.toml"
        (self.folder / "geometry.toml").write_text(
            'job = "geometry"\n[trajectory]\nfile = "track.csv"\ntime_scale = "recorder"\ncrs = "EPSG:25832"\n'
            '[geometry]\ncrs = "EPSG:25832"\n[geometry.quality]\nlimits = "%s"\nspeed_kmh = 160\n[report]\n' % limits)

    def test_numbers_are_those_of_the_files(self):
        done = self.versine("geometry", "geometry.toml", "-o", "result")
        self.assertIn(done.returncode, (0, 1), done.stderr)
        result = self.folder / "result"
        shown = cells(result / "report.html", "exceedances")
        with open(result / "exceedances.csv", newline="") as file:
            exceedances = list(csv.DictReader(file))
        self.assertGreater(len(exceedances), 0)
        for row in exceedances:
            for column in ("length_m", "value", "limit", "easting_m", "northing_m"):
                self.assertIn(row[column], shown)
            peak = float(row["peak_m"])
            self.assertIn("%d+%06.2f" % (peak // 1000, peak % 1000), shown)
        shown = cells(result / "report.html", "sections")
        with open(result / "sections.csv", newline="") as file:
            for row in csv.DictReader(file):
                for column, value in row.items():
                    if column.startswith("sigma_level"):
                        self.assertIn(value, shown)
        largest = {}
        with open(result / "geometry.csv", newline="") as file:
            for row in csv.DictReader(file):
                value = row["level_left_d1_mm"]
                if value and abs(float(value)) > abs(largest.get("value", 0.0)):
                    largest = {"value": float(value), "at": float(row["mileage_m"])}
        summary = cells(result / "report.html", "overview")
        self.assertIn("%.2f" % largest["value"], summary)

    def test_signs_stand_on_every_page(self):
        self.versine("geometry", "geometry.toml", "-o", "result")
        page = (self.folder / "result/report.html").read_text()
        sheets = page.count('<div class="sheet">')
        self.assertGreater(sheets, 6)
        self.assertEqual(len(re.findall("cross level \\+ left rail higher", page)), sheets)


if __name__ == "__main__":
    unittest.main()
