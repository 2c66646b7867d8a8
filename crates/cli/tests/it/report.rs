//! The report of a run as a reader opens it: whole, without a network, in a browser where there is one.

use crate::support::{CaseCopy, albatross};
use std::path::Path;
use std::process::Command;

/// Draws everything at once, whether it is on the screen or not, and writes down what happened.
const PROBE: &str = r#"<script>
(function () {
  const errors = [];
  addEventListener("error", (e) => errors.push(String(e.message)));
  addEventListener("unhandledrejection", (e) => errors.push(String(e.reason)));
  console.error = (...words) => errors.push(words.join(" "));
  window.IntersectionObserver = class {
    constructor(seen) { this.seen = seen; }
    observe(target) { setTimeout(() => this.seen([{ target, isIntersecting: true }], this)); }
    unobserve() {}
  };
  addEventListener("load", () => setTimeout(() => {
    const count = (selector) => document.querySelectorAll(selector).length;
    const root = document.documentElement;
    const found = { plots: count(".plot"), drawn: count(".plot .plot-container"), scenes: count(".shapes canvas"),
      stills: count(".still svg"), overflow: root.scrollWidth - root.clientWidth,
      fetched: performance.getEntriesByType("resource").map((entry) => entry.name), errors };
    const place = document.createElement("pre");
    place.id = "probe";
    place.textContent = JSON.stringify(found);
    document.body.append(place);
  }, 3000));
})();
</script></head>"#;

/// A browser of the Chromium family on the search path.
fn browser() -> Option<&'static str> {
    [
        "chromium",
        "chromium-browser",
        "google-chrome",
        "google-chrome-stable",
        "chrome",
    ]
    .into_iter()
    .find(|name| {
        Command::new(name)
            .arg("--version")
            .output()
            .is_ok_and(|o| o.status.success())
    })
}

fn in_browser(browser: &str, profile: &Path, arguments: &[&str]) -> String {
    let output = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu-sandbox",
            "--enable-unsafe-swiftshader",
        ])
        .args([
            "--force-prefers-reduced-motion",
            "--host-resolver-rules=MAP * ~NOTFOUND",
        ])
        .arg(format!("--user-data-dir={}", profile.display()))
        .args(arguments)
        .output()
        .unwrap();
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn val_report_stands_alone_and_draws_in_a_browser() {
    // A title that would run if it were not escaped, and end the data in which it stands.
    let copy = CaseCopy::new();
    copy.replace(
        "case.toml",
        "title = \"F25-like surrogate, cruise\"",
        "title = \"<script>throw 1</script> & co\"",
    );
    copy.replace("case.toml", "name = \"nz\"", "name = \"<b>n_{z}\"");
    let (case, out) = (copy.arg("case.toml"), copy.arg("out"));
    let run = albatross(&["run", &case, "--out", &out, "--quiet"]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let page = std::fs::read_to_string(copy.at("out").join("report.html")).unwrap();

    assert!(page.len() < 8_000_000, "{} bytes", page.len());
    assert_eq!(page.matches("plotly.js v").count(), 1, "the script is there once");
    let own = page.split("plotly.js v").next().unwrap();
    assert!(own.contains("<h1>&lt;script&gt;throw 1&lt;/script&gt; &amp; co</h1>"));
    assert!(!own.contains("<b>n") && !own.contains("throw 1</script>"));
    for heading in [
        "Summary",
        "Trim",
        "Structure",
        "Modes in the flow",
        "Root locus",
        "Frequency response",
        "Simulations",
        "Strips",
        "Settings",
        "Provenance",
    ] {
        assert!(own.contains(&format!("<h2>{heading}</h2>")), "{heading}");
    }
    for address in ["src=\"http", "href=\"http", "src='http", "url(", "@import"] {
        assert!(!own.contains(address), "{address}");
    }
    // Each plot and the shapes have data that a program can read.
    let data = own.split("<script type=\"application/json\">").skip(1);
    let parsed = data
        .map(|d| serde_json::from_str::<serde_json::Value>(d.split("</script>").next().unwrap()).unwrap());
    assert!(parsed.count() > 10);

    let Some(browser) = browser() else {
        eprintln!("SKIPPED: no Chromium on the search path; the report was not opened in a browser");
        return;
    };
    let probed = copy.at("probe.html");
    std::fs::write(&probed, page.replacen("</head>", PROBE, 1)).unwrap();
    let address = format!("file://{}", probed.display());
    for width in [400, 1280] {
        let profile = copy.at(&format!("profile{width}"));
        let dom = in_browser(
            browser,
            &profile,
            &[
                &format!("--window-size={width},900"),
                "--virtual-time-budget=5000",
                "--dump-dom",
                &address,
            ],
        );
        let found = dom
            .split("<pre id=\"probe\">")
            .nth(1)
            .and_then(|d| d.split("</pre>").next());
        let found: serde_json::Value =
            serde_json::from_str(found.unwrap_or_else(|| panic!("{browser} drew nothing"))).unwrap();
        assert_eq!(found["errors"], serde_json::json!([]), "{width} px");
        assert_eq!(
            found["fetched"],
            serde_json::json!([]),
            "{width} px: nothing is fetched"
        );
        assert_eq!(found["drawn"], found["plots"], "{width} px: {found}");
        assert!(
            found["plots"].as_u64().unwrap() >= 12 && found["stills"].as_u64().unwrap() >= 7,
            "{found}"
        );
        assert_eq!(
            found["overflow"], 0,
            "{width} px: the page is as wide as the screen"
        );
    }
    let pdf = copy.at("report.pdf");
    let profile = copy.at("profile_print");
    in_browser(
        browser,
        &profile,
        &[
            &format!("--print-to-pdf={}", pdf.display()),
            &format!("file://{}", copy.at("out").join("report.html").display()),
        ],
    );
    let printed = std::fs::read(&pdf).unwrap();
    assert!(
        printed.starts_with(b"%PDF") && printed.len() > 100_000,
        "{} bytes",
        printed.len()
    );
}
