"""The report: one HTML file that shows runs, each moving under a slider. Needs bokeh."""

from laglab.results.report.report import MOST_RUNS, report_html, save_report

__all__ = ["MOST_RUNS", "report_html", "save_report"]
